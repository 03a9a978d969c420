#include "dem/stages/sample.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/error.hpp"
#include "dem/checkpoint.hpp"
#include "dem/stages/control.hpp"

namespace dem {

common::Frame read_sample(const common::Scene& scene) {
  const std::string& path = scene.preparation.from;
  common::Frame frame = common::read_frame(path);
  if (frame.stage == common::Stage::shear && frame.frame != 0) {
    throw common::bad_input(fmt::format(
        "{}: is frame {} of a test, expected a prepared sample (stage confinement) or frame 0", path, frame.frame));
  }
  const Phase phase = read_control(frame).phase;
  if (phase != Phase::hold && phase != Phase::shear) {
    throw common::bad_input(fmt::format(
        "{}: is a checkpoint from the middle of a preparation ({}), expected a prepared sample", path, name_of(phase)));
  }
  const common::Particles& p = frame.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double density = p.mass[i] / p.area[i];
    if (!(std::abs(density / scene.material.density - 1) < 1e-9)) {
      throw common::bad_input(
          fmt::format("{}: particle {} has a density of {:.6g} kg/m^3, material.density of the scene is {:.6g}", path,
                      p.id[i], density, scene.material.density));
    }
  }
  return frame;
}

}  // namespace dem
