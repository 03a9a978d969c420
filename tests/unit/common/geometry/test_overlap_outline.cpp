// The outline that `overlap` hands out. Oracles: its own area and chord, and the clip.
#include <catch2/catch.hpp>
#include <cmath>

#include "common/geometry/clip_overlap.hpp"
#include "common/math/random.hpp"

using common::Overlap;
using common::OverlapOutline;
using common::Polygon;
using common::Vec2;

namespace {

Polygon random_polygon(common::Random& random) {
  const int n = 3 + static_cast<int>(random.index(6));
  const double phase = random.uniform(0, 6.283);
  Polygon polygon;
  for (int i = 0; i < n; ++i) {
    polygon.push_back(common::Rotation(phase + 6.283185307179586 * (i + random.uniform(-0.4, 0.4)) / n) * Vec2(1, 0));
  }
  return polygon;
}

}  // namespace

TEST_CASE("the outline of an overlap runs from crossing to crossing, first along b, and bounds the area") {
  common::Random random(23);
  int outlines = 0;
  int without = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Polygon a = random_polygon(random);
    Polygon b = random_polygon(random);
    const Vec2 shift = common::Rotation(random.uniform(0, 6.283)) * Vec2(random.uniform(1.2, 2.0), 0);
    for (Vec2& p : b) p += shift;
    OverlapOutline outline;
    const Overlap o = common::overlap(a, b, &outline);
    if (outline.size == 0) {
      without += o.area > 0;
      continue;
    }
    ++outlines;
    REQUIRE(o.crossings == 2);
    REQUIRE(outline.first_a >= 2);
    REQUIRE(outline.size - outline.first_a >= 2);
    Polygon world;
    for (int i = 0; i < outline.size; ++i) world.push_back(outline.origin + Vec2(outline.x[i], outline.y[i]));
    REQUIRE(std::abs(common::area(world) - o.area) < 1e-12);
    const Vec2& second = world[static_cast<std::size_t>(outline.first_a)];
    REQUIRE((0.5 * (world[0] + second) - o.chord_midpoint).norm() < 1e-12);
    REQUIRE(common::cross(second - world[0], o.normal) > 0);
    for (int i = 1; i < outline.size; ++i) {  // corners between the crossings: b's before the second one, a's after it
      if (i == outline.first_a) continue;
      double nearest = 1;
      for (const Vec2& p : i < outline.first_a ? b : a) nearest = std::min(nearest, (p - world[i]).norm());
      REQUIRE(nearest < 1e-12);
    }

    alignas(32) double coordinates[4][common::kMaxOverlapVertices];
    OverlapOutline clipped;
    common::clip_overlap(common::pack_outline(a.begin(), a.end(), coordinates[0], coordinates[1]),
                         common::pack_outline(b.begin(), b.end(), coordinates[2], coordinates[3]), &clipped);
    REQUIRE(clipped.size == outline.size);
    REQUIRE(clipped.first_a == outline.first_a);
    REQUIRE((clipped.origin - outline.origin).norm() < 1e-12);
    for (int i = 0; i < outline.size; ++i) {
      REQUIRE(std::abs(clipped.x[i] - outline.x[i]) + std::abs(clipped.y[i] - outline.y[i]) < 1e-12);
    }
  }
  CHECK(outlines > 2000);
  CHECK(without > 2000);
}
