// What counts as a failed integration. Oracle: rows made by hand on either side of each limit.
#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "dem/guards.hpp"

namespace {

struct Rows {
  std::vector<double> unbalanced{0.3, 0.025, 0.4};
  double inertial = 1e-4;
  double residual = 4;
};

std::vector<common::Column> history_of(const Rows& rows) {
  const std::size_t n = rows.unbalanced.size();
  return {{"axial_strain", "-", "", std::vector<double>(n, 0.02)},
          {"unbalanced_force", "-", "", rows.unbalanced},
          {"inertial_number", "-", "", std::vector<double>(n, rows.inertial)},
          {"boundary_work", "J", "", std::vector<double>(n, -60)},
          {"elastic_energy", "J", "", std::vector<double>(n, 40)},
          {"energy_residual", "J", "", std::vector<double>(n, rows.residual)}};
}

common::Scene scene_with(bool damping, bool ledger) {
  common::Scene scene;
  scene.effects.local_damping = damping;
  scene.effects.energy_ledger = ledger;
  return scene;
}

}  // namespace

TEST_CASE("a run that rattles from frame to frame is stopped, one that is shaken by a split is not") {
  using Catch::Matchers::Contains;
  const common::Scene scene = scene_with(true, false);
  CHECK_NOTHROW(dem::require_sound(scene, history_of({})));
  Rows rattling;
  rattling.unbalanced = {0.3, 0.035, 0.4};
  CHECK_THROWS_WITH(dem::require_sound(scene, history_of(rattling)), Contains("0.035") && Contains("time_step.safety"));
  try {
    dem::require_sound(scene, history_of(rattling));
  } catch (const common::Error& error) {
    CHECK(error.code() == common::ExitCode::numerical_failure);
  }
  // Without damping nothing comes to rest, and fast loading is not quasi-static.
  CHECK_NOTHROW(dem::require_sound(scene_with(false, false), history_of(rattling)));
  rattling.inertial = 0.02;
  CHECK_NOTHROW(dem::require_sound(scene, history_of(rattling)));
}

TEST_CASE("a ledger that does not close stops the run") {
  const common::Scene scene = scene_with(true, true);
  for (const double residual : {4.9, -4.9}) {
    Rows rows;
    rows.residual = residual;
    CHECK_NOTHROW(dem::require_sound(scene, history_of(rows)));
    rows.residual = 1.05 * residual;
    CHECK_THROWS_WITH(dem::require_sound(scene, history_of(rows)), Catch::Matchers::Contains("residual"));
    CHECK_NOTHROW(dem::require_sound(scene_with(true, false), history_of(rows)));
  }
}
