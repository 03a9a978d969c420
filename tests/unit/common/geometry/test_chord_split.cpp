#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "common/geometry/chord_split.hpp"
#include "tests/unit/common/geometry/shapes.hpp"

using namespace common;
using namespace common::test;
using Catch::Matchers::Contains;

namespace {

int times_in(const Polygon& polygon, const Vec2& point) {
  return static_cast<int>(std::count(polygon.begin(), polygon.end(), point));
}

int shared_vertices(const ChordSplit& split) {
  int shared = 0;
  for (const Vec2& p : split.left) shared += times_in(split.right, p);
  return shared;
}

}  // namespace

TEST_CASE("a square is cut in two between opposite edges, left of the chord first") {
  const ChordSplit split = split_by_chord(box(0, 0, 1, 1), {0.25, 0}, {0.5, 1});
  CHECK(split.left == Polygon{{0.5, 1}, {0, 1}, {0, 0}, {0.25, 0}});
  CHECK(split.right == Polygon{{0.25, 0}, {1, 0}, {1, 1}, {0.5, 1}});
  const ChordSplit back = split_by_chord(box(0, 0, 1, 1), {0.5, 1}, {0.25, 0});
  CHECK(back.left == split.right);
  CHECK(back.right == split.left);
}

TEST_CASE("a chord may end at vertices") {
  const Polygon square = box(0, 0, 1, 1);
  CHECK(split_by_chord(square, {0, 0}, {1, 1}).left == Polygon{{1, 1}, {0, 1}, {0, 0}});
  CHECK(split_by_chord(square, {0, 0}, {1, 1}).right == Polygon{{0, 0}, {1, 0}, {1, 1}});
  CHECK(split_by_chord(square, {0, 0}, {1, 0.5}).right == Polygon{{0, 0}, {1, 0}, {1, 0.5}});
  const Polygon triangle{{0, 0}, {1, 0}, {0, 1}};
  CHECK(split_by_chord(triangle, {0.5, 0.5}, {0, 0}).left == Polygon{{0, 0}, {1, 0}, {0.5, 0.5}});
}

TEST_CASE("chord ends near the boundary move onto it") {
  const ChordSplit split = split_by_chord(box(0, 0, 1, 1), {0.25, -1e-7}, {0.5, 1 - 1e-7});
  CHECK(split.left == Polygon{{0.5, 1}, {0, 1}, {0, 0}, {0.25, 0}});
}

TEST_CASE("a chord end next to a vertex moves to the vertex, further off it does not") {
  const Polygon square = box(0, 0, 1, 1);
  CHECK(split_by_chord(square, {1e-10, 0}, {0.5, 1}).left == Polygon{{0.5, 1}, {0, 1}, {0, 0}});
  CHECK(split_by_chord(square, {0, 1e-10}, {0.5, 1}).right == Polygon{{0, 0}, {1, 0}, {1, 1}, {0.5, 1}});
  CHECK(split_by_chord(square, {1e-8, 0}, {0.5, 1}).left.size() == 4);
  CHECK(split_by_chord(square, {0.01, 0}, {0.5, 1}, 0.02).left.size() == 3);
}

TEST_CASE("pieces of random splits are convex, share the chord bit for bit and keep the area") {
  Random random(31);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Polygon parent =
        moved(random_polygon(random, 0.3, i % 3 == 0 ? 20 : 1), 0, {random.uniform(-1, 1), random.uniform(-1, 1)});
    const std::size_t n = parent.size();
    const std::size_t one = random.index(n);
    const std::size_t two = (one + 1 + random.index(n - 1)) % n;
    const auto on_edge = [&](std::size_t e) {
      return Vec2(parent[e] + random.uniform(0.02, 0.98) * (parent[(e + 1) % n] - parent[e]));
    };
    const Vec2 first = on_edge(one);
    const Vec2 last = on_edge(two);
    const ChordSplit split = split_by_chord(parent, first, last);
    REQUIRE(outline_defect(split.left) == "");
    REQUIRE(outline_defect(split.right) == "");
    REQUIRE(shared_vertices(split) == 2);
    REQUIRE(split.left.size() + split.right.size() == n + 4);
    REQUIRE(cross(last - first, centroid(split.left) - first) > 0);
    REQUIRE(cross(last - first, centroid(split.right) - first) < 0);
    const double sum = area(split.left) + area(split.right);
    worst = std::max(worst, std::abs(sum - area(parent)) / area(parent));
  }
  CHECK(worst < 1e-12);
}

TEST_CASE("four generations of splits keep the area to rounding") {
  Random random(32);
  for (int i = 0; i < 200; ++i) {
    const Polygon parent = random_polygon(random, 0.3);
    std::vector<Polygon> pieces{parent};
    for (int generation = 0; generation < 4; ++generation) {
      std::vector<Polygon> smaller;
      for (const Polygon& piece : pieces) {
        const Vec2 first = 0.5 * (piece[0] + piece[1]);
        const std::size_t opposite = piece.size() / 2;
        const Vec2 last = 0.5 * (piece[opposite] + piece[(opposite + 1) % piece.size()]);
        ChordSplit split = split_by_chord(piece, first, last);
        smaller.push_back(std::move(split.left));
        smaller.push_back(std::move(split.right));
      }
      pieces = std::move(smaller);
    }
    double sum = 0;
    for (const Polygon& piece : pieces) {
      REQUIRE(outline_defect(piece) == "");
      sum += area(piece);
    }
    REQUIRE(pieces.size() == 16);
    REQUIRE(sum == Approx(area(parent)).epsilon(1e-12));
  }
}

TEST_CASE("chords that do not cut are refused with the reason") {
  const Polygon square = box(0, 0, 1, 1);
  CHECK_THROWS_WITH(split_by_chord(square, {0.2, 0}, {0.8, 0}), Contains("lie on one edge"));
  CHECK_THROWS_WITH(split_by_chord(square, {0, 0}, {1, 0}), Contains("lie on one edge"));
  CHECK_THROWS_WITH(split_by_chord(square, {0, 0}, {0, 0.5}), Contains("lie on one edge"));
  CHECK_THROWS_WITH(split_by_chord(square, {0.5, 1}, {0.5, 1}), Contains("lie on one edge"));
  CHECK_THROWS_WITH(split_by_chord(square, {0.5, 0.5}, {0.5, 1}), Contains("(0.5, 0.5) is 0.5 m off"));
  CHECK_THROWS_WITH(split_by_chord(square, {0.5, 0}, {std::nan(""), 1}), Contains("off the polygon's boundary"));
  const Polygon flat_corner{{0, 0}, {1, -1e-16}, {2, 0}, {1, 1}};
  CHECK_THROWS_WITH(split_by_chord(flat_corner, {0, 0}, {2, 0}), Contains("both pieces must have an area"));
  try {
    split_by_chord(square, {0.2, 0}, {0.8, 0});
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::numerical_failure);
  }
}
