#include "dem/contacts_of.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "dem/checkpoint.hpp"
#include "dem/engine.hpp"

namespace dem {
namespace {

// Fills the arrays that follow from the outlines, and zeros for motion that the file does not tell of.
void complete(Particles& p, double density) {
  const std::size_t n = p.size();
  const auto fill = [n](auto& values, const auto& value) {
    if (values.empty()) values.assign(n, value);
  };
  if (p.root.empty()) p.root = p.id;
  fill(p.parent, std::int64_t{-1});
  fill(p.generation, std::int32_t{0});
  fill(p.type, std::int32_t{-1});
  fill(p.velocity, Vec2(Vec2::Zero()));
  fill(p.displacement, Vec2(Vec2::Zero()));
  fill(p.angular_velocity, 0.0);
  const auto measure = [&p, n](std::vector<double>& values, const auto& measured) {
    if (!values.empty()) return;
    for (std::size_t i = 0; i < n; ++i) values.push_back(measured(p.outline(i)));
  };
  measure(p.area, [](common::PolygonView outline) { return common::area(outline); });
  measure(p.mass, [&](common::PolygonView outline) { return density * common::area(outline); });
  measure(p.inertia, [&](common::PolygonView outline) { return density * common::polar_moment(outline); });
}

}  // namespace

void write_contacts_of(const std::filesystem::path& particles, const common::Scene& scene,
                       const std::filesystem::path& out) {
  common::Frame frame = common::read_frame(particles, common::FrameContent::particles);
  complete(frame.particles, scene.material.density);
  State state;
  state.particles = std::move(frame.particles);
  state.contacts = contacts_in(frame.contacts, state.particles);
  state.ring = indices_of(frame.ring, state.particles);
  state.friction = scene.effects.friction ? scene.contact.friction : 0;
  state.next_id = state.particles.size() == 0 ? 0 : state.particles.id.back() + 1;

  const Engine engine(scene, std::move(state));
  common::Frame result = to_frame(engine.state(), scene, common::Stage::shear);
  result.frame = frame.frame;
  result.axial_strain = frame.axial_strain;
  result.config_hash = common::config_hash(scene, common::UsedBy::dem);
  common::write_frame(out, result, scene.output.durability);
}

}  // namespace dem
