// The screening bound against the solve that it spares.
#include "xfem/screening/influence.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/unit/xfem/outlines.hpp"
#include "xfem/breakage.hpp"

using namespace xfem;
using namespace test_outlines;

namespace {

/// 1 to 40 forces on the boundary: pressing or pulling, at corners or between, balanced or not.
std::vector<Load> random_loads(common::Random& random, const Polygon& outline) {
  const int count =
      random.index(4) == 0 ? 1 + static_cast<int>(random.index(40)) : 2 + static_cast<int>(random.index(5));
  const bool at_corners = random.index(4) == 0;
  const double pull = random.index(3) == 0 ? 1 : 0;
  std::vector<Load> loads;
  for (int k = 0; k < count; ++k) {
    const std::size_t i = random.index(outline.size());
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    const Vec2 inward = common::perpendicular(edge).normalized();
    const double t = at_corners ? 0 : random.uniform();
    // Contact points stand a little inside.
    const Vec2 point = outline[i] + t * edge + random.uniform(0, 0.01) * inward;
    const double size = std::pow(10, random.uniform(-2, 0));
    loads.push_back(
        {point, size * (random.uniform(-pull, 1) * inward + random.uniform(-0.5, 0.5) * edge.normalized())});
  }
  if (random.index(2) == 0) {
    Vec2 sum = Vec2::Zero();
    for (const Load& load : loads) sum += load.force;
    loads.push_back({outline[random.index(outline.size())], -sum});
  }
  return loads;
}

double exact(const ParticleModel& model, const std::vector<Load>& loads, const HoekBrown& rock) {
  const std::vector<Stress> stress =
      model.average(model.elastic.stresses(model.elastic.solve(model.elastic.nodal_forces(loads))));
  double smallest = std::numeric_limits<double>::infinity();
  for (const Stress& s : stress) {
    const PrincipalStress p = principal(s);
    smallest = std::min(smallest, rock.load_factor(p.s1, p.s3));
  }
  return smallest;
}

}  // namespace

TEST_CASE("No particle that fails is screened, and hardly any that does not is solved", "[screening]") {
  common::Random random(11);
  int loads_tried = 0, failing = 0, wasted = 0;
  std::vector<double> slack;
  for (int k = 0; k < 150; ++k) {
    Polygon outline = random_outline(random, random.uniform(0.3, 1));
    if (k % 3 == 0) {
      const Polygon part = left_part(outline, {random.uniform(-0.5, 0.5), 0}, {random.uniform(-1, 1), 1});
      if (part.size() >= 3 && common::outline_defect(part).empty()) outline = part;
    }
    if (k % 15 == 1) outline = {{0, 0}, {50, 0}, {50, 1}, {0, 1}};
    const double radius = k % 4 == 0 ? 0 : 0.1;
    const ParticleModel model(canonical(outline), std::array{28, 75, 150}[k % 3], {1, 0.2}, radius);
    const Influence influence(model.elastic, model.average, model.outline);
    for (int trial = 0; trial < 40; ++trial) {
      const HoekBrown rock{1, random.uniform(4, 35)};
      std::vector<Load> loads = random_loads(random, model.outline);
      // Around the load at which it fails, so that the verdict is not a matter of course.
      const double size = exact(model, loads, rock) / (1 + 0.01 * random.uniform(-1, 1));
      for (Load& load : loads) load.force *= size;
      const double factor = exact(model, loads, rock);
      const Influence::Bound bound = influence.bound(loads, rock);
      INFO("outline " << k << ", loads " << trial << ", factor " << factor << ", bound " << bound.safety_factor);
      REQUIRE(bound.safety_factor < factor);
      if (factor <= 1) REQUIRE_FALSE(bound.safety_factor > 1);
      ++loads_tried;
      failing += factor <= 1;
      wasted += factor > 1 && !(bound.safety_factor > 1);
      slack.push_back(1 - bound.safety_factor / factor);
    }
  }
  CHECK(failing > loads_tried / 3);
  std::sort(slack.begin(), slack.end());
  CHECK(slack[slack.size() / 2] < 5e-4);
  CHECK(slack[slack.size() * 99 / 100] < 5e-3);
  CHECK(slack.back() < 0.05);
  // Of those within 1 % of failure, 2 % are solved that need not be.
  CHECK(wasted < (loads_tried - failing) / 40);
}

TEST_CASE("The mean stress of a screened particle is that of its elements", "[screening]") {
  common::Random random(12);
  for (int k = 0; k < 60; ++k) {
    const Polygon outline = random_outline(random, random.uniform(0.3, 1));
    const ParticleModel model(canonical(outline), 75, {1, 0.2}, 0.1);
    const Influence influence(model.elastic, model.average, model.outline);
    const std::vector<Load> loads = random_loads(random, model.outline);
    const std::vector<Stress> stress = model.elastic.stresses(model.elastic.solve(model.elastic.nodal_forces(loads)));
    const Stress expected = mean_stress(model.elastic.mesh(), stress);
    const Stress found = influence.bound(loads, {1, 25}).mean_stress;
    double size = 0;
    for (const Stress& s : stress) size = std::max({size, std::abs(s.xx), std::abs(s.yy), std::abs(s.xy)});
    CHECK(std::abs(found.xx - expected.xx) < 1e-12 * size);
    CHECK(std::abs(found.yy - expected.yy) < 1e-12 * size);
    CHECK(std::abs(found.xy - expected.xy) < 1e-12 * size);
  }
}

TEST_CASE("The analysis finds the load factor that the bound is compared with", "[screening]") {
  common::Random random(13);
  int screened = 0;
  for (int k = 0; k < 60; ++k) {
    const Polygon outline = random_outline(random, random.uniform(0.5, 1));
    const ParticleModel model(canonical(outline), 75, {1, 0.2}, 0.1);
    const Influence influence(model.elastic, model.average, model.outline);
    std::vector<Load> loads = random_loads(random, model.outline);
    BreakageParameters parameters;
    parameters.rock = {1, 25};
    for (Load& load : loads) load.force *= exact(model, loads, parameters.rock) / 1.001;
    const BreakageResult result = analyse(model, loads, {}, parameters);
    const double bound = influence.bound(loads, parameters.rock).safety_factor;
    CHECK(bound < result.min_safety_factor);
    if (!(bound > 1)) continue;
    ++screened;
    CHECK(result.status == common::ParticleStatus::intact);
    CHECK(result.cracks.empty());
  }
  CHECK(screened > 5);
}

TEST_CASE("Without forces nothing fails, with forces beyond numbers nothing is promised", "[screening]") {
  const ParticleModel model(canonical(regular(6, 1)), 75, {1, 0.2}, 0.1);
  const Influence influence(model.elastic, model.average, model.outline);
  CHECK(std::isinf(influence.bound({}, {1, 25}).safety_factor));
  for (const double force : {std::nan(""), std::numeric_limits<double>::infinity(), 1e308}) {
    const std::vector<Load> loads{{{0.5, 0}, {force, 1}}, {{-0.5, 0}, {1, force}}};
    CHECK_FALSE(influence.bound(loads, {1, 25}).safety_factor > 1);
  }
  // Forces too small or too large for single precision, in proportion.
  const std::vector<Load> loads{{{0.5, 0}, {-1, 0}}, {{-0.5, 0}, {1, 0}}};
  const double factor = influence.bound(loads, {1, 25}).safety_factor;
  for (const double size : {1e-60, 1e60}) {
    std::vector<Load> scaled = loads;
    for (Load& load : scaled) load.force *= size;
    CHECK(influence.bound(scaled, {size, 25}).safety_factor == Approx(factor).epsilon(1e-6));
  }
}
