// The pair search against trying every pair.
#include <catch2/catch.hpp>

#include "common/math/random.hpp"
#include "dem/neighbours.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::Vec2;

namespace {

std::vector<std::pair<int, int>> search(const dem::State& state, double skin) {
  dem::WorldOutlines outlines;
  outlines.reset(state.particles);
  dem::Neighbours neighbours(skin);
  std::vector<dem::Pair> pairs;
  neighbours.rebuild(state.particles, outlines, pairs);
  std::vector<std::pair<int, int>> found;
  for (const dem::Pair& p : pairs) found.push_back({p.a, p.b});
  return found;
}

std::vector<std::pair<int, int>> try_every_pair(const dem::State& state, double skin) {
  const auto& p = state.particles;
  std::vector<std::pair<int, int>> found;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      const double reach =
          common::radius_about(p.outline(i), Vec2::Zero()) + common::radius_about(p.outline(j), Vec2::Zero()) + skin;
      if (p.boundary[i] && p.boundary[j]) continue;
      if ((p.position[j] - p.position[i]).squaredNorm() <= reach * reach) {
        found.push_back({static_cast<int>(i), static_cast<int>(j)});
      }
    }
  }
  return found;
}

/// `ratio`: of the largest size to the smallest, evenly over the orders of magnitude between.
dem::State scattered(int count, double ratio, double width, std::uint64_t seed) {
  common::Random random(seed);
  dem::State state;
  for (int i = 0; i < count; ++i) {
    double size = 1;
    for (double step = ratio; step > 1; step /= 2) {
      if (random.uniform() < 0.5) size /= std::min(step, 2.0);
    }
    const double x = random.uniform(-width, width);
    bodies::add(state, bodies::hexagon(size), Vec2(x, random.uniform(-width, width)));
    state.particles.boundary.back() = random.uniform() < 0.2;
  }
  return state;
}

}  // namespace

TEST_CASE("the pair search finds what trying every pair finds, in order") {
  for (const double ratio : {1.0, 1.5, 8.0, 100.0}) {
    for (const double skin : {0.0, 0.05, 1.0}) {
      const dem::State state = scattered(400, ratio, 12, 7);
      CAPTURE(ratio, skin);
      const auto expected = try_every_pair(state, skin);
      REQUIRE(expected.size() > 40);
      CHECK(search(state, skin) == expected);
    }
  }
}

TEST_CASE("particles that fly off, however far, cost no pair of the others") {
  dem::State state = scattered(200, 4, 8, 3);
  const auto expected = try_every_pair(state, 0.1);
  for (const Vec2& far : {Vec2(1e6, -3e7), Vec2(-1e14, 2), Vec2(1e200, 1e300), Vec2(0, 1e308)}) {
    bodies::add(state, bodies::hexagon(1), far);
  }
  CHECK(search(state, 0.1) == expected);
  bodies::add(state, bodies::hexagon(1), Vec2(std::nan(""), 0));
  CHECK(search(state, 0.1) == expected);
}

TEST_CASE("a pair list is outdated once a particle has moved by more than half the skin, not before") {
  dem::State state = scattered(50, 2, 5, 1);
  dem::WorldOutlines outlines;
  outlines.reset(state.particles);
  dem::Neighbours neighbours(0.2);
  std::vector<dem::Pair> pairs;
  neighbours.rebuild(state.particles, outlines, pairs);
  CHECK_FALSE(neighbours.outdated(state.particles, 0, 50));
  state.particles.angle[20] += 1;
  state.particles.position[20].x() += 0.0999;
  CHECK_FALSE(neighbours.outdated(state.particles, 0, 50));
  state.particles.position[20].x() += 0.0002;
  CHECK(neighbours.outdated(state.particles, 0, 50));
  CHECK_FALSE(neighbours.outdated(state.particles, 21, 50));
  state.particles.position[20].x() = std::nan("");
  CHECK(neighbours.outdated(state.particles, 0, 50));
}
