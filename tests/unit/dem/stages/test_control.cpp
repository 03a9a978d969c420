// The boundary of a sample whose particles break. Oracle: the sample before.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
#include "dem/measures.hpp"
#include "dem/stages/control.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::Vec2;

namespace {

/// Hexagons side by side, four rings of them around a first, one of the rim missing; those inside the rim whole or as
/// four pieces each.
dem::State cluster(bool broken) {
  const double spacing = 0.4;
  const double radius = spacing / std::sqrt(3.0);
  dem::State state;
  std::int64_t original = 0;
  for (int row = -4; row <= 4; ++row) {
    for (int k = -4; k <= 4; ++k) {
      const int rim = std::max({std::abs(row), std::abs(k), std::abs(row + k)});
      if (rim > 4 || (row == -4 && k == 2)) continue;
      const Vec2 at(spacing * (k + 0.5 * row), spacing * std::sqrt(0.75) * row);
      if (rim == 4 || !broken) {
        bodies::add(state, bodies::hexagon(radius), at, 0.5235987755982988);
        state.particles.root.back() = original;
      } else {
        const double side = std::sqrt(bodies::sums(state.particles).area / static_cast<double>(original)) / 2;
        for (const Vec2& offset : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
          bodies::add(state, bodies::box(side, side), at + side / 2 * offset);
          state.particles.root.back() = original;
        }
      }
      ++original;
    }
  }
  return state;
}

std::vector<std::int64_t> ring_roots(bool broken) {
  dem::Engine engine(common::Scene{}, cluster(broken));
  dem::outline_ring(engine);
  std::vector<std::int64_t> roots;
  for (const std::int32_t i : engine.state().ring) roots.push_back(engine.state().particles.root[i]);
  return roots;
}

/// Area of the particles that are not in the ring.
double inside(const dem::State& state) {
  double area = 0;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    const bool rim = std::find(state.ring.begin(), state.ring.end(), static_cast<std::int32_t>(i)) != state.ring.end();
    if (!rim) area += state.particles.area[i];
  }
  return area;
}

}  // namespace

TEST_CASE("fragments inside do not change the boundary: the ball that finds it has the size of the originals") {
  const std::vector<std::int64_t> whole = ring_roots(false);
  CHECK(whole.size() == 23);
  CHECK(ring_roots(true) == whole);
}

TEST_CASE("a particle that leaves the ring is let go unless it would be pressed hard by the boundary") {
  // The particle beside the gap in the rim (the first of the second ring) is in the boundary though the ball misses it.
  common::Scene scene;
  scene.effects.friction = true;
  for (const bool deep : {false, true}) {
    dem::State state = cluster(false);
    auto& p = state.particles;
    // All touch by a hair; the first of the rim and one behind it, which was in the boundary, by 1 cm if `deep`.
    for (Vec2& at : p.position) at *= 1 - 1e-4;
    const std::int32_t inner = 6;  // row -3, in the second ring
    const std::int32_t outer = 1;  // row -4, in the rim
    if (deep) p.position[inner] += 0.01 * (p.position[outer] - p.position[inner]).normalized();
    p.boundary[inner] = 1;
    dem::Engine engine(scene, state);
    dem::renew_ring(engine);  // the rim is flagged
    engine.edit().particles.boundary[inner] = 1;
    engine.restart();
    dem::renew_ring(engine);
    const auto& ring = engine.state().ring;
    REQUIRE(std::find(ring.begin(), ring.end(), inner) == ring.end());
    REQUIRE(std::find(ring.begin(), ring.end(), outer) != ring.end());
    CHECK(engine.state().particles.boundary[inner] == (deep ? 1 : 0));
    // Staying in the boundary makes nobody a part of the ring polygon, and takes nobody out of the solids inside it.
    CHECK(dem::void_ratios(engine.state()).e4 == Approx(dem::ring_area(engine.state()) / inside(engine.state()) - 1));
  }
}

TEST_CASE("a state without a boundary ring, or with nothing inside it, is refused") {
  const auto assembly = [](const std::vector<Vec2>& places) {
    dem::State state;
    for (const Vec2& at : places) bodies::add(state, bodies::hexagon(0.2), at, 0.0);
    dem::Engine engine(common::Scene{}, state);
    dem::outline_ring(engine);
    return engine.state();
  };
  const std::vector<Vec2> around{{0.4, 0}, {0, 0.4}, {-0.4, 0}, {0, -0.4}};
  std::vector<Vec2> filled = around;
  filled.push_back({0.01, 0.02});
  CHECK_NOTHROW(dem::require_interior(assembly(filled)));
  CHECK_THROWS_WITH(dem::require_interior(assembly(around)), Catch::Matchers::Contains("found 4, of which 4 lie on"));
  CHECK_THROWS_WITH(dem::require_interior(assembly({{0, 0}, {0.4, 0}})), Catch::Matchers::Contains("found 2"));
  dem::State driven = assembly(filled);
  driven.particles.boundary.assign(5, 1);
  CHECK_THROWS_WITH(dem::require_interior(driven), Catch::Matchers::Contains("found 5, of which 5 lie on"));
}
