// Random bodies, poses, collisions and cuts for the evidence on contact laws; a function of the seed alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/error.hpp"
#include "common/geometry/chord_split.hpp"
#include "common/math/random.hpp"
#include "dem/contact/laws.hpp"
#include "dem/engine.hpp"
#include "dem/stages/generate.hpp"
#include "tests/unit/dem/bodies.hpp"

namespace contacts {

using common::Polygon;
using common::Vec2;

constexpr double kTwoPi = 6.283185307179586;

enum class Bodies { whole, fragments };  ///< of the generator (5 to 8 corners), or what a random chord cuts off them

inline Vec2 direction(common::Random& random) {
  return common::Rotation(random.uniform(0, kTwoPi)) * Vec2(1, 0);
}

/// Diameter 0.37 to 0.57 m before the cut; centroid at the origin.
inline Polygon body(Bodies kind, common::Random& random) {
  common::ShapeOptions options;
  options.types = 4;
  Polygon p = dem::make_shape_types(options, random)[random.index(4)];
  const double diameter = random.uniform(0.37, 0.57);
  for (Vec2& v : p) v *= diameter;
  if (kind == Bodies::fragments) {
    const std::size_t n = p.size();
    const std::size_t i = random.index(n);
    const std::size_t j = (i + 1 + random.index(n - 1)) % n;
    const auto on_edge = [&](std::size_t k) -> Vec2 {
      return p[k] + random.uniform(0.02, 0.98) * (p[(k + 1) % n] - p[k]);
    };
    const Vec2 first = on_edge(i);
    const common::ChordSplit halves = common::split_by_chord(p, first, on_edge(j));
    p = random.uniform() < 0.5 ? halves.left : halves.right;
  }
  const Vec2 center = common::centroid(p);
  for (Vec2& v : p) v -= center;
  return p;
}

inline Polygon placed(const Polygon& p, const Vec2& at, double angle) {
  const common::Rotation turn(angle);
  Polygon world;
  for (const Vec2& v : p) world.push_back(at + turn * v);
  return world;
}

template <class Law>
dem::NormalAction action(const Polygon& a, const Polygon& b, const dem::ContactConstants& constants) {
  common::OverlapOutline outline;
  const common::Overlap o = common::overlap(a, b, &outline);
  return o.area > 0 ? Law::action(o, outline, constants) : dem::NormalAction{0, 0, Vec2::Zero(), Vec2::Zero()};
}

/// Two bodies about to touch, without friction or damping, so fast that a face would enter by 3e-4 to 3e-2 diameters at
/// 1e9 N/m; their momentum is zero. Nothing if they pass each other.
inline std::optional<dem::State> approach(Bodies kind, std::uint64_t seed) {
  common::Random random(seed);
  const std::array<Polygon, 2> bodies = {body(kind, random), body(kind, random)};
  const std::array<double, 2> angle = {random.uniform(0, kTwoPi), random.uniform(0, kTwoPi)};
  const Vec2 line = direction(random);
  const double bound = common::radius_about(bodies[0], Vec2::Zero()) + common::radius_about(bodies[1], Vec2::Zero());
  const Vec2 aside = random.uniform(-0.35, 0.35) * bound * common::perpendicular(line);
  const double fraction = 3e-4 * std::pow(100.0, random.uniform());
  const double spin = random.uniform(-1, 1);

  const Polygon fixed = placed(bodies[0], Vec2::Zero(), angle[0]);
  const auto touch = [&](double distance) {
    return common::overlap(fixed, placed(bodies[1], distance * line + aside, angle[1])).area > 0;
  };
  double apart = bound;
  double close = bound;
  while (close > 0 && !touch(close)) close -= bound / 200;
  if (close <= 0) return std::nullopt;
  for (int k = 0; k < 40; ++k) (touch(0.5 * (apart + close)) ? close : apart) = 0.5 * (apart + close);

  dem::State state;
  bodies::add(state, bodies[0], Vec2::Zero(), angle[0]);
  bodies::add(state, bodies[1], apart * line + aside, angle[1]);
  auto& p = state.particles;
  const double mass = p.mass[0] * p.mass[1] / (p.mass[0] + p.mass[1]);
  const double diameter = std::min(common::diameter(bodies[0]), common::diameter(bodies[1]));
  const double speed = fraction * diameter * std::sqrt(1e9 / mass);
  p.velocity = {speed * mass / p.mass[0] * line, -speed * mass / p.mass[1] * line};
  p.angular_velocity[1] = spin * speed / bound;
  return state;
}

struct Collision {
  double depth = 0;  ///< greatest A / b over the smaller diameter
  double error = 0;  ///< energy after / before - 1
};

inline std::optional<Collision> collide(const common::Scene& scene, const dem::State& start) {
  dem::Engine engine(scene, start);
  const double energy = dem::kinetic_energy(start.particles);
  const double diameter =
      std::min(common::diameter(start.particles.outline(0)), common::diameter(start.particles.outline(1)));
  Collision result;
  bool touched = false;
  for (int k = 0; k < 100000; ++k) {
    engine.step({});
    if (!engine.state().contacts.empty()) {
      const dem::Contact& c = engine.state().contacts[0];
      result.depth = std::max(result.depth, c.overlap_area / c.overlap_width / diameter);
      touched = true;
    } else if (touched) {
      result.error = dem::kinetic_energy(engine.state().particles) / energy - 1;
      return result;
    }
  }
  return std::nullopt;
}

/// A contact 0.2 to 1 % of a diameter deep, and the two pieces that a chord through it makes of b.
struct CutContact {
  Polygon a, b, left, right;
};

inline CutContact cut_contact(common::Random& random) {
  for (;;) {
    const Polygon a = placed(body(Bodies::whole, random), Vec2::Zero(), 0);
    const Polygon b =
        placed(body(Bodies::whole, random), random.uniform(0.3, 0.5) * direction(random), random.uniform(0, kTwoPi));
    const common::Overlap o = common::overlap(a, b);
    if (!(o.area > 2e-3 * 0.47 * o.width) || o.area > 1e-2 * 0.47 * o.width) continue;
    const Vec2 start = o.chord_midpoint + random.uniform(-0.45, 0.45) * o.width * common::perpendicular(o.normal);
    const Vec2 line = common::Rotation(random.uniform(-0.7, 0.7)) * o.normal;
    std::vector<Vec2> ends;
    for (std::size_t i = 0; i < b.size(); ++i) {
      const Vec2 edge = b[(i + 1) % b.size()] - b[i];
      const double u = common::cross(b[i] - start, line) / common::cross(line, edge);
      if (u >= 0 && u < 1) ends.push_back(b[i] + u * edge);
    }
    if (ends.size() != 2) continue;
    const common::ChordSplit halves = common::split_by_chord(b, ends[0], ends[1]);
    if (std::min(common::area(halves.left), common::area(halves.right)) < 0.05 * common::area(b)) continue;
    if (!(common::overlap(a, halves.left).area > 0) || !(common::overlap(a, halves.right).area > 0)) continue;
    return {a, b, halves.left, halves.right};
  }
}

struct CutForces {
  double sum = 0;     ///< (|f_left| + |f_right|) / |f|
  double change = 0;  ///< |f_left + f_right - f| / |f|
  double energy = 0;  ///< (U_left + U_right) / U
};

template <class Law>
CutForces forces_of(const CutContact& cut, const dem::ContactConstants& constants) {
  const dem::NormalAction whole = action<Law>(cut.a, cut.b, constants);
  const dem::NormalAction left = action<Law>(cut.a, cut.left, constants);
  const dem::NormalAction right = action<Law>(cut.a, cut.right, constants);
  return {(left.force + right.force) / whole.force,
          (left.force * left.normal + right.force * right.normal - whole.force * whole.normal).norm() / whole.force,
          (left.energy + right.energy) / whole.energy};
}

}  // namespace contacts
