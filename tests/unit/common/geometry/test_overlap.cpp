// Special positions with known answers, and symmetries, of the overlap kernel.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/geometry/chord_split.hpp"
#include "common/geometry/overlap.hpp"
#include "tests/unit/common/geometry/shapes.hpp"

using namespace common;
using namespace common::test;

namespace {

bool near(const Vec2& found, const Vec2& expected) {
  return (found - expected).norm() < 1e-14;
}

}  // namespace

TEST_CASE("a corner in a corner has a chord between the two crossings") {
  const Overlap found = overlap(box(0, 0, 1, 1), box(0.7, 0.6, 1, 1));
  CHECK(found.area == Approx(0.12).epsilon(1e-14));
  CHECK(found.crossings == 2);
  CHECK(found.width == Approx(0.5).epsilon(1e-14));
  CHECK(near(found.normal, {0.8, 0.6}));
  CHECK(near(found.centroid, {0.85, 0.8}));
  CHECK(near(found.chord_midpoint, {0.85, 0.8}));
}

TEST_CASE("a vertex pressed into an edge has the edge's normal") {
  const Polygon diamond{{0, -0.1}, {1, 0.9}, {0, 1.9}, {-1, 0.9}};
  const Overlap found = overlap(box(-2, -1, 4, 1), diamond);
  CHECK(found.area == Approx(0.01).epsilon(1e-13));
  CHECK(found.crossings == 2);
  CHECK(found.width == Approx(0.2).epsilon(1e-13));
  CHECK(near(found.normal, {0, 1}));
  CHECK(near(found.centroid, {0, -0.1 / 3}));
  CHECK(near(found.chord_midpoint, {0, 0}));
}

TEST_CASE("four crossings have the chord of the summed boundary pieces") {
  const Overlap found = overlap(box(-2, -0.5, 4, 1), box(-0.5, -2, 1, 2.25));
  CHECK(found.area == Approx(0.75).epsilon(1e-14));
  CHECK(found.crossings == 2);
  CHECK(near(found.normal, {0, -1}));
  const Overlap bars = overlap(box(-2, -0.5, 4, 1), box(-0.5, -2, 1, 4));
  CHECK(bars.area == Approx(1).epsilon(1e-14));
  CHECK(bars.crossings == 4);
  CHECK(bars.width == Approx(1).epsilon(1e-14));  // no chord: moving b changes nothing
  CHECK(near(bars.normal, {1, 0}));
  CHECK(near(bars.chord_midpoint, {0, 0}));
}

TEST_CASE("a polygon inside another is pushed along the centre line") {
  const Polygon outer = box(0, 0, 4, 4);
  const Polygon inner = box(2.5, 1.5, 0.5, 1);
  for (const bool swapped : {false, true}) {
    const Overlap found = swapped ? overlap(inner, outer) : overlap(outer, inner);
    CHECK(found.area == Approx(0.5).epsilon(1e-14));
    CHECK(found.crossings == 0);
    CHECK(found.width == Approx(std::sqrt(0.5)).epsilon(1e-14));
    CHECK(near(found.normal, {swapped ? -1 : 1, 0}));
    CHECK(near(found.centroid, {2.75, 2}));
    CHECK(near(found.chord_midpoint, {2.75, 2}));
  }
  const Overlap centred = overlap(outer, box(1, 1, 2, 2));
  CHECK(near(centred.normal, {1, 0}));
}

TEST_CASE("a polygon inside another with a vertex or an edge on its boundary stays well defined") {
  const Polygon diamond{{1, 0}, {2, 1}, {1, 2}, {0, 1}};
  const Overlap on_vertex = overlap(box(-3, 0, 8, 8), diamond);
  CHECK(on_vertex.area == Approx(2).epsilon(1e-14));
  CHECK(on_vertex.crossings == 0);
  CHECK(on_vertex.normal.y() < 0);  // from the outer centre (1, 4) to the inner one (1, 1)
  const Overlap on_edge = overlap(box(0, 0, 4, 4), box(3, 1, 1, 2));
  CHECK(on_edge.area == Approx(2).epsilon(1e-14));
  CHECK(near(on_edge.normal, {1, 0}));
  CHECK(on_edge.width == Approx(2).epsilon(1e-14));
}

TEST_CASE("identical polygons overlap fully, without a crossing, in any position") {
  Random random(21);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 shift(random.uniform(-100, 100), random.uniform(-100, 100));
    const Polygon a = moved(random_polygon(random, 0.3), 0, shift);
    Polygon b = a;
    std::rotate(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(random.index(b.size())), b.end());
    const Overlap found = overlap(a, b);
    REQUIRE(found.area == Approx(area(a)).epsilon(1e-12));
    REQUIRE(found.crossings == 0);
    REQUIRE(near(found.normal, {1, 0}));
    REQUIRE((found.centroid - centroid(a)).norm() < 1e-13);
  }
}

TEST_CASE("touching and separated polygons do not overlap") {
  const Polygon unit = box(0, 0, 1, 1);
  const Polygon diamond{{2, 0.5}, {1.5, 1}, {1, 0.5}, {1.5, 0}};
  for (const Polygon& other : {box(1, 0, 1, 1), box(1, 0.25, 1, 3), box(0.2, 1, 0.1, 1), box(1, 1, 1, 1),
                               box(-1, -1, 1, 1), diamond, box(1.5, 0, 1, 1), box(0, 1 + 1e-15, 1, 1)}) {
    for (const Overlap& found : {overlap(unit, other), overlap(other, unit)}) {
      CHECK(found.area == 0);
      CHECK(found.width == 0);
      CHECK(found.normal == Vec2(0, 0));
      CHECK(found.crossings == 0);
    }
  }
}

TEST_CASE("a narrow deep overlap has its width raised to the root of its area") {
  // A needle of width 0.01 pushed 0.5 deep through an edge: area 0.005, chord 0.01.
  const Overlap found = overlap(box(0, 0, 1, 1), box(0.4, -1, 0.01, 1.5));
  CHECK(found.area == Approx(0.005).epsilon(1e-13));
  CHECK(found.width == Approx(std::sqrt(0.005)).epsilon(1e-13));
  CHECK(near(found.normal, {0, -1}));
}

TEST_CASE("the normal points from a to b for shallow contacts") {
  Random random(22);
  int tested = 0;
  while (tested < 5000) {
    const Polygon a = random_polygon(random, 0.25);
    const SinCos at = sin_cos(random.uniform(0, 2 * kPi));
    const Polygon b = moved(random_polygon(random, 0.25), 0, random.uniform(0.3, 0.5) * Vec2(at.cos, at.sin));
    const Overlap found = overlap(a, b);
    if (found.area == 0 || found.area > 0.02 * std::min(area(a), area(b))) continue;
    REQUIRE(found.normal.dot(centroid(b) - centroid(a)) > 0);
    ++tested;
  }
}

TEST_CASE("swapping the polygons turns the normal round and leaves the rest") {
  Random random(23);
  int tested = 0;
  for (int i = 0; i < 10000; ++i) {
    const double aspect = random.uniform(1, 5);
    const Polygon a = random_polygon(random, 0.3, aspect);
    const SinCos at = sin_cos(random.uniform(0, 2 * kPi));
    const Polygon b = moved(random_polygon(random, 0.3, aspect), 0, random.uniform(0, 0.5) * Vec2(at.cos, at.sin));
    const Overlap one = overlap(a, b);
    const Overlap other = overlap(b, a);
    REQUIRE(one.area == Approx(other.area).epsilon(1e-11).margin(1e-17));
    if (one.area < 1e-10) continue;
    REQUIRE(one.crossings == other.crossings);
    REQUIRE(one.width == Approx(other.width).epsilon(1e-9));
    REQUIRE((one.normal + other.normal).norm() < 1e-9);
    REQUIRE((one.centroid - other.centroid).norm() < 1e-9);
    REQUIRE((one.chord_midpoint - other.chord_midpoint).norm() < 1e-9);
    ++tested;
  }
  CHECK(tested > 5000);
}

TEST_CASE("the overlap turns and moves with the polygons") {
  Random random(24);
  int tested = 0;
  while (tested < 2000) {
    const Polygon a = random_polygon(random, 0.3);
    const Polygon b = moved(random_polygon(random, 0.3), 0, {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)});
    const Overlap before = overlap(a, b);
    if (before.area < 1e-8) continue;
    const double angle = random.uniform(-10, 10);
    const Vec2 shift(random.uniform(-5, 5), random.uniform(-5, 5));
    const Overlap after = overlap(moved(a, angle, shift), moved(b, angle, shift));
    const Rotation rotation(angle);
    REQUIRE(after.area == Approx(before.area).epsilon(1e-7));
    REQUIRE((after.normal - rotation * before.normal).norm() < 1e-8);
    REQUIRE((after.centroid - (rotation * before.centroid + shift)).norm() < 1e-8);
    REQUIRE((after.chord_midpoint - (rotation * before.chord_midpoint + shift)).norm() < 1e-8);
    ++tested;
  }
}

TEST_CASE("polygons with the largest number of vertices overlap as circles do") {
  const int n = kMaxOverlapVertices / 2;
  Polygon circle;
  for (int i = 0; i < n; ++i) {
    const SinCos at = sin_cos(2 * kPi * i / n);
    circle.push_back({at.cos, at.sin});
  }
  const Overlap found = overlap(circle, moved(circle, 0.03, {1, 0}));
  // Two unit circles one radius apart: a lens of area 2 pi / 3 - sqrt(3) / 2 and width sqrt(3).
  CHECK(found.area == Approx(2 * kPi / 3 - std::sqrt(3.0) / 2).epsilon(0.005));
  CHECK(found.width == Approx(std::sqrt(3.0)).epsilon(0.005));
  CHECK(found.crossings == 2);
  const Overlap same = overlap(circle, circle);
  CHECK(same.area == Approx(area(circle)).epsilon(1e-13));
}

TEST_CASE("coordinates that are not numbers give no overlap") {
  Polygon broken = box(0.5, 0.5, 1, 1);
  for (Vec2& p : broken) p.setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(overlap(box(0, 0, 1, 1), broken).area == 0);
  CHECK(overlap(broken, box(0, 0, 1, 1)).area == 0);
}

TEST_CASE("siblings of a split overlap by rounding at most") {
  Random random(25);
  for (int i = 0; i < 2000; ++i) {
    const Polygon parent = random_polygon(random, 0.3);
    const std::size_t n = parent.size();
    const std::size_t one = random.index(n);
    const std::size_t two = (one + 1 + random.index(n - 1)) % n;
    const auto on_edge = [&](std::size_t e) {
      return Vec2(parent[e] + random.uniform(0.05, 0.95) * (parent[(e + 1) % n] - parent[e]));
    };
    const Vec2 first = on_edge(one);
    const Vec2 last = on_edge(two);
    const ChordSplit split = split_by_chord(parent, first, last);
    REQUIRE(overlap(split.left, split.right).area == 0);
    const double angle = random.uniform(-3, 3);
    const Vec2 shift(random.uniform(-10, 10), random.uniform(-10, 10));
    REQUIRE(overlap(moved(split.left, angle, shift), moved(split.right, angle, shift)).area < 1e-14);
  }
}
