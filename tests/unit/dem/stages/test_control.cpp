// The boundary of a sample whose particles break. Oracle: the sample before.
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
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

}  // namespace

TEST_CASE("fragments inside do not change the boundary: the ball that finds it has the size of the originals") {
  const std::vector<std::int64_t> whole = ring_roots(false);
  CHECK(whole.size() == 23);
  CHECK(ring_roots(true) == whole);
}
