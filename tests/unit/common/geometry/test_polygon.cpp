#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/geometry/polygon.hpp"
#include "tests/unit/common/geometry/shapes.hpp"

using namespace common;
using namespace common::test;
using Catch::Matchers::Contains;

namespace {

Polygon regular(int n, double radius) {
  Polygon polygon;
  for (int i = 0; i < n; ++i) {
    const SinCos at = sin_cos(2 * kPi * i / n);
    polygon.push_back({radius * at.cos, radius * at.sin});
  }
  return polygon;
}

}  // namespace

TEST_CASE("rectangle, triangle and regular polygons have their textbook measures") {
  const Polygon rectangle = box(2, 3, 4, 1);
  CHECK(area(rectangle) == Approx(4).epsilon(1e-15));
  CHECK(centroid(rectangle) == Vec2(4, 3.5));
  CHECK(polar_moment(rectangle) == Approx(4 * (16 + 1) / 12.0).epsilon(1e-14));
  CHECK(diameter(rectangle) == Approx(std::sqrt(17.0)).epsilon(1e-15));
  CHECK(radius_about(rectangle, {2, 3}) == Approx(std::sqrt(17.0)).epsilon(1e-15));

  // Triangle: J = A (sum of squared edges) / 36.
  const Polygon triangle{{0, 0}, {3, 0}, {0, 4}};
  CHECK(area(triangle) == Approx(6).epsilon(1e-15));
  CHECK((centroid(triangle) - Vec2(1, 4.0 / 3)).norm() < 1e-15);
  CHECK(polar_moment(triangle) == Approx(6 * (9 + 16 + 25) / 36.0).epsilon(1e-14));

  // Regular n-gon: A = n/2 r^2 sin(2 pi/n), J = A r^2 / 6 (2 + cos(2 pi/n)).
  for (int n = 3; n < 40; ++n) {
    const Polygon polygon = regular(n, 0.7);
    const double expected = 0.5 * n * 0.49 * std::sin(2 * kPi / n);
    CHECK(area(polygon) == Approx(expected).epsilon(1e-14));
    CHECK(centroid(polygon).norm() < 1e-15);
    CHECK(polar_moment(polygon) == Approx(expected * 0.49 / 6 * (2 + std::cos(2 * kPi / n))).epsilon(1e-13));
    CHECK(radius_about(polygon, Vec2::Zero()) == Approx(0.7).epsilon(1e-15));
  }
  CHECK(equivalent_diameter(kPi) == Approx(2).epsilon(1e-15));
}

TEST_CASE("polygon measures follow rotations and translations") {
  Random random(41);
  for (int i = 0; i < 1000; ++i) {
    const Polygon polygon = random_polygon(random, 0.4, random.uniform(1, 5));
    const double angle = random.uniform(-10, 10);
    const Vec2 shift(random.uniform(-100, 100), random.uniform(-100, 100));
    const Polygon there = moved(polygon, angle, shift);
    REQUIRE(area(there) == Approx(area(polygon)).epsilon(1e-11));
    REQUIRE(polar_moment(there) == Approx(polar_moment(polygon)).epsilon(1e-10));
    REQUIRE(diameter(there) == Approx(diameter(polygon)).epsilon(1e-12));
    REQUIRE((centroid(there) - (Rotation(angle) * centroid(polygon) + shift)).norm() < 1e-12);
  }
}

TEST_CASE("the measures of clockwise polygons keep their centroid and turn their area") {
  const Polygon clockwise{{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  CHECK(area(clockwise) == -1);
  CHECK(centroid(clockwise) == Vec2(0.5, 0.5));
}

TEST_CASE("a point is inside, on the boundary or outside") {
  const Polygon triangle{{0, 0}, {2, 0}, {0, 2}};
  CHECK(contains(triangle, {0.5, 0.5}));
  CHECK(contains(triangle, {1, 1}));
  CHECK(contains(triangle, {0, 0}));
  CHECK_FALSE(contains(triangle, {1.01, 1}));
  CHECK_FALSE(contains(triangle, {-1e-9, 1}));
  CHECK_FALSE(contains(triangle, {1, -1e-9}));
}

TEST_CASE("usable outlines have no defect") {
  CHECK(outline_defect(box(-100, 50, 0.4, 0.3)) == "");
  CHECK(outline_defect(regular(1000, 1)) == "");
  CHECK(outline_defect(Polygon{{0, 0}, {1, 0}, {2, 0}, {0, 1}}) == "");      // a vertex within an edge
  CHECK(outline_defect(Polygon{{0, 0}, {1, 1e-15}, {2, 0}, {0, 1}}) == "");  // reflex by rounding only
  Random random(42);
  for (int i = 0; i < 1000; ++i) REQUIRE(outline_defect(random_polygon(random, 0.3, 20)) == "");
}

TEST_CASE("each defect of an outline is named with its vertex") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(outline_defect(Polygon{}), Contains("0 vertices; at least 3"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {1, 0}}), Contains("2 vertices; at least 3"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {1, 0}, {nan, 1}}), Contains("vertex 2 (nan, 1) is not finite"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {INFINITY, 0}, {0, 1}}), Contains("vertex 1 (inf, 0) is not finite"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {1, 0}, {1, 0}, {0, 1}}), Contains("vertex 1 (1, 0) is repeated by"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {1, 0}, {0, 1}, {0, 0}}), Contains("repeated by vertex 0"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {1, 0}, {2, 0}}), Contains("no area"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {0, 1}, {1, 0}}), Contains("clockwise"));
  CHECK_THAT(outline_defect(Polygon{{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}),
             Contains("not convex at vertex 2 (0.5, 0.5)"));
  // A pentagram turns left at every corner, but goes around twice.
  Polygon star;
  for (int i = 0; i < 5; ++i) {
    const SinCos at = sin_cos(4 * kPi * i / 5);
    star.push_back({at.cos, at.sin});
  }
  CHECK_THAT(outline_defect(star), Contains("not convex"));
}
