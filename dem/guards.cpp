#include "dem/guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.hpp"

namespace dem {

void require_sound(const common::Scene& scene, const std::vector<common::Column>& history) {
  constexpr double kRattling = 0.03;
  constexpr double kSlow = 0.01;
  constexpr double kResidual = 0.05;
  const auto column = [&](const char* name) -> const std::vector<double>& {
    const auto found = std::find_if(history.begin(), history.end(), [&](const auto& c) { return c.name == name; });
    if (found == history.end() || found->values.empty()) {
      throw common::numerical_failure(fmt::format("history/{}: no row since the last frame", name));
    }
    return found->values;
  };
  const auto stop = [&](const std::string& found) {
    return common::numerical_failure(fmt::format(
        "axial strain {:.5f}: {}; the time step may be too large (time_step.safety is {}), the sample stiffer "
        "than the servo takes it for (servo.modulus is {:.3g} Pa) or far from rest under its pressure",
        column("axial_strain").back(), found, scene.time_step.safety, scene.servo.modulus));
  };
  if (scene.effects.local_damping) {
    const std::vector<double>& unbalanced = column("unbalanced_force");
    const std::vector<double>& inertial = column("inertial_number");
    const double least = *std::min_element(unbalanced.begin(), unbalanced.end());
    if (least > kRattling && *std::max_element(inertial.begin(), inertial.end()) < kSlow) {
      throw stop(fmt::format("the unbalanced force is {:.2g} or more since the last frame, expected below {} at rest",
                             least, kRattling));
    }
  }
  if (scene.effects.energy_ledger) {
    double scale = std::abs(column("boundary_work").back()) + column("elastic_energy").back();
    if (scene.effects.gravity) scale += std::abs(column("gravity_work").back());
    const double residual = column("energy_residual").back();
    if (std::abs(residual) > kResidual * scale) {
      throw stop(
          fmt::format("the energy residual is {:.3g} J, expected within {} of {:.3g} J", residual, kResidual, scale));
    }
  }
}

}  // namespace dem
