// Thousands of random particles under random contact forces: whatever happens, the result is one of the known states,
// its numbers are finite, its pieces fill the particle, and a stored state that is loaded again stays as it is.
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/physics/xfem/crack/result_defect.hpp"
#include "tests/unit/xfem/outlines.hpp"
#include "xfem/breakage.hpp"

using namespace xfem;
using common::ParticleStatus;
using result_check::same_cracks;

namespace {

/// Random pushes on the edges, the last correction shared by all so that they balance; empty if one then pulls.
std::vector<Load> random_contacts(common::Random& random, const Polygon& outline, int count) {
  std::vector<Load> loads;
  std::vector<Vec2> inward;
  for (int i = 0; i < count; ++i) {
    const std::size_t edge = i * outline.size() / count;
    const Vec2& a = outline[edge];
    const Vec2 along = outline[(edge + 1) % outline.size()] - a;
    inward.push_back(common::perpendicular(along).normalized());
    const double push = random.uniform(0.05, 1) * random.uniform(0.05, 1) * 1e6;
    const double slide = random.uniform(-0.4, 0.4);
    loads.push_back({a + random.uniform(0.03, 0.97) * along, push * (inward[i] + slide * along.normalized())});
  }
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  const auto columns = [](const Vec2& x) {
    Eigen::Matrix<double, 3, 2> c;
    c << 1, 0, 0, 1, -x.y(), x.x();
    return c;
  };
  for (const Load& load : loads) {
    gram += columns(load.point) * columns(load.point).transpose();
    residual += columns(load.point) * load.force;
  }
  const Eigen::Vector3d correction = gram.inverse() * residual;
  for (int i = 0; i < count; ++i) {
    loads[i].force -= columns(loads[i].point).transpose() * correction;
    if (loads[i].force.dot(inward[i]) < 0) return {};
  }
  return loads;
}

void check_result(const ParticleModel& model, const BreakageResult& result, const BreakageParameters& parameters) {
  REQUIRE(result_check::result_defect(model, result, parameters) == "");
  CHECK_FALSE(result_check::cuts_twice(model.elastic.mesh(), result.cracks));
}

}  // namespace

TEST_CASE("Random particles end in a known state that holds when it is loaded again", "[crack][physics]") {
  common::Random random(2024);
  std::array<std::array<int, 6>, 4> outcomes{};
  const std::array<double, 4> factors{1, 2, 5, 1000};
  int particles = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Polygon outline = test_outlines::random_outline(random, random.uniform(0.5, 1));
    for (Vec2& vertex : outline) vertex *= 0.25;
    const std::vector<Load> loads = random_contacts(random, outline, 2 + static_cast<int>(random.index(5)));
    if (loads.empty()) continue;
    ++particles;
    const ParticleModel model(outline, trial % 4 == 0 ? 150 : 75, {20e9, 0.2}, 0.1);
    BreakageParameters parameters;
    parameters.minimum_area = 0;
    parameters.literal = trial % 5 == 4;
    parameters.load_patch = trial % 3 == 2 ? 0.08 : 0;
    const BreakageResult unit = analyse(model, loads, {}, parameters);
    CHECK(unit.min_safety_factor > 0);
    std::vector<Crack> cracks;
    for (std::size_t level = 0; level < factors.size(); ++level) {
      parameters.load_factor = factors[level] * unit.min_safety_factor * (1 + 1e-9);
      const BreakageResult result = analyse(model, loads, cracks, parameters);
      check_result(model, result, parameters);
      CHECK((result.status == ParticleStatus::broken || result.status == ParticleStatus::arrested));
      ++outcomes[level][static_cast<int>(result.status)];
      const BreakageResult again = analyse(model, loads, cracks, parameters);
      CHECK(same_cracks(again.cracks, result.cracks));
      CHECK(again.mean_stress.xx == result.mean_stress.xx);
      if (result.status == ParticleStatus::broken) break;
      const BreakageResult stored = analyse(model, loads, result.cracks, parameters);
      CHECK(stored.status == result.status);
      CHECK(stored.growth_steps == 0);
      CHECK(same_cracks(stored.cracks, result.cracks));
      cracks = result.cracks;
    }
  }
  CHECK(particles > 200);
  for (const auto& level : outcomes) {
    CHECK(level[static_cast<int>(ParticleStatus::refused)] == 0);
    CHECK(level[static_cast<int>(ParticleStatus::broken)] > 0);
  }
  INFO("broken at 1, 2, 5, 1000 times the initiation load: " << outcomes[0][3] << " " << outcomes[1][3] << " "
                                                             << outcomes[2][3] << " " << outcomes[3][3] << " of "
                                                             << particles);
  CHECK(outcomes[0][3] + outcomes[1][3] + outcomes[2][3] > particles / 2);
}
