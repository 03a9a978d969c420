// Oracle: the definition. A ball that touches both ends of a ring edge from outside holds no centre; every centre is
// inside the polygon or on it; the polygon is simple.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "common/math/random.hpp"
#include "dem/boundary/ring.hpp"

using common::cross;
using common::Vec2;
using dem::find_ring;
using Indices = std::vector<std::int32_t>;

namespace {

/// Points in a disc of unit radius, none nearer to another one than `gap`, by random trial.
std::vector<Vec2> disc(common::Random& random, int count, double gap) {
  std::vector<Vec2> points;
  for (int trial = 0; trial < 200 * count && static_cast<int>(points.size()) < count; ++trial) {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const Vec2 p(x, y);
    if (p.squaredNorm() > 1) continue;
    if (std::all_of(points.begin(), points.end(), [&](const Vec2& q) { return (p - q).norm() > gap; })) {
      points.push_back(p);
    }
  }
  return points;
}

double area(const std::vector<Vec2>& points, const Indices& ring) {
  double twice = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) twice += cross(points[ring[k]], points[ring[(k + 1) % ring.size()]]);
  return twice / 2;
}

/// Strictly: edges on one line do not count, whatever rounding makes of them.
bool crosses(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < -1e-24 && cross(d - c, a - c) * cross(d - c, b - c) < -1e-24;
}

bool simple(const std::vector<Vec2>& points, const Indices& ring) {
  const std::size_t n = ring.size();
  Indices sorted = ring;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (crosses(points[ring[i]], points[ring[i + 1]], points[ring[j]], points[ring[(j + 1) % n]])) return false;
    }
  }
  return true;
}

bool inside(const std::vector<Vec2>& points, const Indices& ring, const Vec2& p) {
  bool odd = false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2& a = points[ring[k]];
    const Vec2& b = points[ring[(k + 1) % ring.size()]];
    if ((a.y() > p.y()) != (b.y() > p.y())) {
      odd ^= p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    }
  }
  return odd;
}

/// Centres that are neither in the ring nor inside it.
int outside(const std::vector<Vec2>& points, const Indices& ring) {
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::find(ring.begin(), ring.end(), static_cast<std::int32_t>(i)) != ring.end()) continue;
    count += !inside(points, ring, points[i]);
  }
  return count;
}

/// The deepest that a centre sits in a ball that rests outside on a ring edge, in radii; 0 if all balls are empty.
double deepest_in_ball(const std::vector<Vec2>& points, const Indices& ring, double radius) {
  double depth = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2& a = points[ring[k]];
    const Vec2& b = points[ring[(k + 1) % ring.size()]];
    const double half = (b - a).norm() / 2;
    REQUIRE(half < radius);
    const Vec2 ball =
        (a + b) / 2 - std::sqrt(radius * radius - half * half) * common::perpendicular(b - a) / (2 * half);
    for (const Vec2& p : points) depth = std::max(depth, 1 - (p - ball).norm() / radius);
  }
  return depth;
}

}  // namespace

TEST_CASE("the ring of random discs is a simple polygon, its balls are empty and it holds the disc") {
  common::Random random(11);
  for (int sample = 0; sample < 40; ++sample) {
    const auto points = disc(random, 400, 0.06);
    const double spacing = std::sqrt(3.14159 / points.size());
    const double radius = 1.5 * spacing;
    const Indices ring = find_ring(points, radius);
    REQUIRE(ring.size() > 30);
    CHECK(simple(points, ring));
    CHECK(deepest_in_ball(points, ring, radius) < 1e-9);
    CHECK(area(points, ring) > 0.8 * 3.14159);
    CHECK(outside(points, ring) == 0);
    CHECK(ring[0] == *std::min_element(ring.begin(), ring.end()));
  }
}

TEST_CASE("a small ball that pinches clouds into many loops still leaves one simple ring around most of them") {
  common::Random random(12);
  int lost = 0;
  int all = 0;
  for (int sample = 0; sample < 200; ++sample) {
    const auto points = disc(random, 60 + static_cast<int>(random.index(100)), 0.01);
    const double radius = random.uniform(0.6, 1.2) * std::sqrt(3.14159 / points.size());
    const Indices ring = find_ring(points, radius);
    REQUIRE(ring.size() >= 3);
    CHECK(simple(points, ring));
    CHECK(area(points, ring) > 0);
    lost += outside(points, ring);
    all += static_cast<int>(points.size());
  }
  CHECK(lost < 0.1 * all);
}

TEST_CASE("the ring moves with the points") {
  common::Random random(13);
  const auto points = disc(random, 300, 0.07);
  const Indices ring = find_ring(points, 0.16);
  for (const double angle : {0.3, 1.7, 3.0, 5.5}) {
    const common::Rotation turn(angle);
    auto moved = points;
    for (Vec2& p : moved) p = 3.0 * (turn * p) + Vec2(1000, -70);
    CHECK(find_ring(moved, 0.48) == ring);
  }
}

TEST_CASE("fugitives are left out") {
  common::Random random(14);
  auto points = disc(random, 300, 0.07);
  const Indices ring = find_ring(points, 0.16);
  points.insert(points.end(), {Vec2(1e9, 3), Vec2(-1e9, -1e9), Vec2(1.9, 0), Vec2(0, -1.9), Vec2(0.05, -1.9)});
  CHECK(find_ring(points, 0.16) == ring);
}

TEST_CASE("what hangs at the rest by one centre is cut off") {
  std::vector<Vec2> points;
  for (int i = 0; i < 25; ++i) points.push_back(Vec2(i % 5, i / 5));
  const Indices ring = find_ring(points, 0.9);
  CHECK(ring == Indices{0, 1, 2, 3, 4, 9, 14, 19, 24, 23, 22, 21, 20, 15, 10, 5});
  points.insert(points.end(), {Vec2(2, -1.5), Vec2(2, -3), Vec2(2.5, -4), Vec2(1.5, -4)});  // a chain and a small loop
  CHECK(find_ring(points, 0.9) == ring);
}

TEST_CASE("a dent is followed by a small ball and bridged by a large one") {
  std::vector<Vec2> points;
  for (int i = 0; i < 49; ++i) points.push_back(Vec2(i % 7, i / 7));
  points.erase(points.begin() + 2, points.begin() + 5);  // three of the lowest row
  CHECK(area(points, find_ring(points, 0.8)) == Approx(36 - 4 + 1));
  CHECK(area(points, find_ring(points, 3.0)) == Approx(36));
}

TEST_CASE("regular lattices, where every ball touches many centres at once, have their hull as the ring") {
  for (const double angle : {0.0, 0.1, 0.7853981633974483}) {
    const common::Rotation turn(angle);
    for (const double shear : {0.0, 0.5}) {
      std::vector<Vec2> points;
      for (int i = 0; i < 100; ++i) {
        const int row = i / 10;
        points.push_back(turn * Vec2(i % 10 + shear * row, row * std::sqrt(1 - shear * shear)));
      }
      for (const double radius : {0.75, 1.5, 4.0}) {
        const Indices ring = find_ring(points, radius);
        CHECK(simple(points, ring));
        CHECK(area(points, ring) == Approx(81 * std::sqrt(1 - shear * shear)));
        CHECK(ring.size() == 36);
      }
    }
  }
  std::vector<Vec2> circle;
  for (int i = 0; i < 100; ++i) circle.push_back(common::Rotation(0.06283185307179587 * i) * Vec2(1, 0));
  for (const double radius : {0.2, 1.0, 2.0}) CHECK(find_ring(circle, radius).size() == 100);
}

TEST_CASE("sizes of 10 to 1 give a ring that holds all centres when the ball suits the large ones") {
  common::Random random(15);
  std::vector<Vec2> points;
  std::vector<double> radii;
  for (int trial = 0; trial < 40000; ++trial) {
    const double r = trial < 2000 ? 0.2 : trial < 8000 ? 0.1 : 0.02;
    const double x = random.uniform(-2, 2);
    const double y = random.uniform(-2, 2);
    const Vec2 p(x, y);
    if (p.norm() > 2) continue;
    bool free = true;
    for (std::size_t k = 0; k < points.size() && free; ++k) free = (points[k] - p).norm() > radii[k] + r;
    if (free) points.push_back(p), radii.push_back(r);
  }
  const Indices ring = find_ring(points, 0.3);
  CHECK(simple(points, ring));
  CHECK(outside(points, ring) == 0);
  CHECK(deepest_in_ball(points, ring, 0.3) < 1e-9);
}

TEST_CASE("too few centres, centres on a line and repeated centres are handled") {
  CHECK(find_ring({}, 1).empty());
  CHECK(find_ring(std::vector<Vec2>{Vec2(0, 0)}, 1).empty());
  CHECK(find_ring(std::vector<Vec2>{Vec2(0, 0), Vec2(1, 0)}, 1).empty());
  CHECK(find_ring(std::vector<Vec2>{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}, 1) == Indices{0, 1, 2});
  CHECK(find_ring(std::vector<Vec2>{Vec2(0, 0), Vec2(0, 1), Vec2(1, 0)}, 1e-3) == Indices{0, 2, 1});
  CHECK(find_ring(std::vector<Vec2>{Vec2(0, 0), Vec2(1, 0), Vec2(2, 0), Vec2(5, 0)}, 1).empty());
  CHECK(find_ring(std::vector<Vec2>{Vec2(0, 0), Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 0)}, 1).size() == 3);
  CHECK(find_ring(std::vector<Vec2>(5, Vec2(3, 4)), 1).empty());
  CHECK_THROWS_AS(find_ring(std::vector<Vec2>(5, Vec2(3, 4)), 0), common::Error);
  CHECK_THROWS_AS(find_ring(std::vector<Vec2>{Vec2(0, 0), Vec2(NAN, 0), Vec2(0, 1)}, 1), common::Error);
}
