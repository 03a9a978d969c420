// Oracles of the foundation law: quadrature of its energy over the two outlines, finite differences of that energy,
// hand values.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "dem/contact/foundation.hpp"
#include "tests/physics/dem/random_contacts.hpp"

using common::Polygon;
using common::Vec2;
using contacts::Bodies;

namespace {

const dem::ContactConstants kUnit{1, 1, 1};

dem::NormalAction act(const Polygon& a, const Polygon& b) {
  return contacts::action<dem::FoundationLaw>(a, b, kUnit);
}

/// Length of the line's part inside both polygons.
double common_length(const Polygon& a, const Polygon& b, const Vec2& start, const Vec2& line) {
  double from = -10, to = 10;
  for (const Polygon* p : {&a, &b}) {
    for (std::size_t i = 0; i < p->size(); ++i) {
      const Vec2 edge = (*p)[(i + 1) % p->size()] - (*p)[i];
      const double slope = common::cross(edge, line);
      const double at = common::cross(edge, (*p)[i] - start) / slope;
      if (slope > 0) from = std::max(from, at);
      if (slope < 0) to = std::min(to, at);
    }
  }
  return std::max(0.0, to - from);
}

struct Kind {
  int crossings = 0, size = 0, first_a = 0;
  bool operator==(const Kind&) const = default;
};

Kind kind_of(const Polygon& a, const Polygon& b) {
  common::OverlapOutline outline;
  const common::Overlap o = common::overlap(a, b, &outline);
  if (outline.size == 0) return {o.crossings, 0, 0};
  return {o.crossings, outline.size, outline.first_a};
}

struct Pose {
  Polygon a, b;  ///< b about its own centroid
  Vec2 at;
  double angle;
  double depth;
  Polygon moved(double x, double y, double turn) const { return contacts::placed(b, at + Vec2(x, y), angle + turn); }
};

Pose random_pose(Bodies kind, common::Random& random) {
  for (;;) {
    const Polygon a = contacts::body(kind, random);
    Pose pose{a, contacts::body(kind, random), random.uniform(0.1, 0.5) * contacts::direction(random),
              random.uniform(0, contacts::kTwoPi), 0};
    const common::Overlap o = common::overlap(pose.a, pose.moved(0, 0, 0));
    pose.depth = o.area / o.width;
    if (o.crossings == 2 && pose.depth > 1e-5 && pose.depth < 0.01) return pose;
  }
}

}  // namespace

TEST_CASE("force and moment of the foundation law are the gradient of its energy") {
  for (const Bodies bodies : {Bodies::whole, Bodies::fragments}) {
    common::Random random(11);
    int checked = 0, two_sided = 0;
    double worst = 0;
    while (checked < 3000) {
      const Pose pose = random_pose(bodies, random);
      const Polygon here = pose.moved(0, 0, 0);
      const Kind kind = kind_of(pose.a, here);
      const dem::NormalAction now = act(pose.a, here);
      const double area = common::overlap(pose.a, here).area;
      if (std::abs(now.force / area - 1) > 0.2) continue;  // towards the limit, where it is no gradient
      const double h = 1e-4 * pose.depth;
      bool smooth = true;
      const auto slope = [&](double x, double y, double turn) {
        const Polygon back = pose.moved(-h * x, -h * y, -h * turn);
        const Polygon on = pose.moved(h * x, h * y, h * turn);
        smooth &= kind_of(pose.a, back) == kind && kind_of(pose.a, on) == kind;
        return (act(pose.a, on).energy - act(pose.a, back).energy) / (2 * h);
      };
      const Vec2 force(-slope(1, 0, 0), -slope(0, 1, 0));
      const double moment = -slope(0, 0, 1);
      if (!smooth) continue;
      const Vec2 found = now.force * now.normal;
      worst = std::max({worst, (found - force).norm() / now.force,
                        std::abs(common::cross(now.point - pose.at, found) - moment) / (0.3 * now.force)});
      ++checked;
      two_sided += kind.size > 0;
    }
    CAPTURE(static_cast<int>(bodies), two_sided, worst);
    CHECK(two_sided > 200);
    CHECK(worst < 1e-5);
  }
}

TEST_CASE("the energy of the foundation law is half the stiffness times the integral of the depth squared") {
  common::Random random(5);
  int two_sided = 0;
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const Pose pose = random_pose(Bodies::whole, random);
    const Polygon b = pose.moved(0, 0, 0);
    const common::Overlap o = common::overlap(pose.a, b);
    const Vec2 along = common::perpendicular(o.normal);
    constexpr int kPoints = 4000;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
      const double s = ((i + 0.5) / kPoints - 0.5) * o.width;
      const double depth = common_length(pose.a, b, o.chord_midpoint + s * along, o.normal);
      sum += 0.5 * depth * depth * o.width / kPoints;
    }
    // What overhangs the ends of the chord would need a second look: few corners are that sharp.
    const auto reaches = [&](double s) {
      return common_length(pose.a, b, o.chord_midpoint + s * o.width * along, o.normal) > 0;
    };
    if (reaches(-0.5 - 1e-6) || reaches(0.5 + 1e-6)) continue;
    worst = std::max(worst, std::abs(act(pose.a, b).energy / sum - 1));
    two_sided += kind_of(pose.a, b).size > 0;
  }
  CAPTURE(worst, two_sided);
  CHECK(two_sided > 100);
  CHECK(worst < 1e-4);  // of the midpoint rule at a boundary that is almost parallel to the normal
}

TEST_CASE("two equal wedges that meet head on push each other apart along their axis") {
  const double half = 0.1, height = 0.02;
  const Polygon below = {Vec2(-1, -1), Vec2(1, -1), Vec2(half, 0), Vec2(0, height), Vec2(-half, 0)};
  const Polygon above = {Vec2(1, 1), Vec2(-1, 1), Vec2(-half, 0), Vec2(0, -height), Vec2(half, 0)};
  const dem::NormalAction found = act(below, above);
  CHECK(found.force == Approx(2 * half * height).epsilon(1e-12));  // k times the area
  CHECK(found.energy == Approx(2 * half * 4 * height * height / 6).epsilon(1e-12));
  CHECK((found.normal - Vec2(0, 1)).norm() < 1e-12);
  CHECK(std::abs(found.point.x()) < 1e-12);
}

TEST_CASE("blocks that share the lines of their sides are told apart by rounding at most") {
  // The crossings lie anywhere on the sides that coincide; all of them give the force of the overlap's area upwards.
  for (const double shift : {0.0, 1e-18, -1e-16, 1e-13, -1e-9}) {
    const Polygon below = contacts::placed(bodies::box(1, 0.5), Vec2(0.3, 0.1), 0);
    const Polygon above = contacts::placed(bodies::box(1, 0.5), Vec2(0.3 + shift, 0.599), 0);
    const dem::NormalAction found = act(below, above);
    CHECK(found.force == Approx(0.001).epsilon(2e-3));
    CHECK(found.energy == Approx(0.5e-6).epsilon(2e-3));
    CHECK((found.normal - Vec2(0, 1)).norm() < 2e-3);
    CHECK((found.point - Vec2(0.3, 0.3495)).norm() < 2e-3);
  }
}

TEST_CASE("along a path the foundation law's force hardly jumps where a crossing passes a corner") {
  common::Random random(9);
  std::vector<double> jumps;
  while (jumps.size() < 1000) {
    const Pose pose = random_pose(Bodies::whole, random);
    if (pose.depth < 1e-3) continue;
    const Vec2 motion = contacts::direction(random);
    const double turn = random.uniform(-2, 2);
    const auto force = [&](double way) -> Vec2 {
      const dem::NormalAction found = act(pose.a, pose.moved(way * motion.x(), way * motion.y(), way * turn));
      return found.force * found.normal;
    };
    double largest = 0;
    for (int step = 0; step < 20; ++step) {  // bisect each step towards its largest change
      double from = 0.1 * step * pose.depth, to = from + 0.1 * pose.depth;
      Vec2 start = force(from), end = force(to);
      const double scale = std::max(start.norm(), end.norm());
      if (start.norm() == 0 || end.norm() == 0) break;
      for (int k = 0; k < 22; ++k) {
        const double middle = 0.5 * (from + to);
        const Vec2 there = force(middle);
        const bool first = (there - start).norm() > (end - there).norm();
        (first ? to : from) = middle;
        (first ? end : start) = there;
      }
      largest = std::max(largest, (end - start).norm() / scale);
    }
    jumps.push_back(largest);
  }
  std::sort(jumps.begin(), jumps.end());
  CAPTURE(jumps[980], jumps[990], jumps.back());
  CHECK(jumps[990] < 1e-5);
  CHECK(jumps.back() < 0.03);
}

TEST_CASE("however deep and narrow, the foundation law stays within half of the area law") {
  common::Random random(3);
  int limited = 0;
  for (int k = 0; k < 20000; ++k) {
    const Polygon a = contacts::body(Bodies::fragments, random);
    const Polygon b = contacts::placed(contacts::body(Bodies::fragments, random),
                                       random.uniform(0, 0.5) * contacts::direction(random), random.uniform(0, 6.28));
    common::OverlapOutline outline;
    const common::Overlap o = common::overlap(a, b, &outline);
    if (!(o.area > 0)) continue;
    const dem::NormalAction found = dem::FoundationLaw::action(o, outline, kUnit);
    const double difference = (found.force * found.normal - o.area * o.normal).norm();
    REQUIRE(difference <= 0.5 * o.area * (1 + 1e-12));
    REQUIRE((found.point - o.centroid).norm() <= o.width * (1 + 1e-12));
    REQUIRE(std::isfinite(found.energy));
    REQUIRE(found.energy >= 0);
    limited += difference > 0.499 * o.area;
  }
  CHECK(limited > 20);
}
