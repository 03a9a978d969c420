// Hand-made assemblies for the tests of dem, and what a closed system conserves.
#pragma once

#include "common/geometry/polygon.hpp"
#include "dem/state.hpp"

namespace bodies {

using common::Polygon;
using common::Vec2;

inline constexpr double kDensity = 2500;

/// Adds a particle with the next id, at rest; `outline` has its centroid at the origin.
inline void add(dem::State& state, const Polygon& outline, const Vec2& at, double angle = 0) {
  auto& p = state.particles;
  p.id.push_back(state.next_id);
  p.parent.push_back(-1);
  p.root.push_back(state.next_id++);
  p.generation.push_back(0);
  p.type.push_back(0);
  p.position.push_back(at);
  p.velocity.push_back(Vec2::Zero());
  p.displacement.push_back(Vec2::Zero());
  p.angle.push_back(angle);
  p.angular_velocity.push_back(0);
  p.area.push_back(common::area(outline));
  p.mass.push_back(kDensity * p.area.back());
  p.inertia.push_back(kDensity * common::polar_moment(outline));
  p.boundary.push_back(0);
  p.vertices.insert(p.vertices.end(), outline.begin(), outline.end());
  p.vertex_offset.push_back(static_cast<std::int64_t>(p.vertices.size()));
}

inline Polygon box(double width, double height) {
  const double x = width / 2;
  const double y = height / 2;
  return {Vec2(-x, -y), Vec2(x, -y), Vec2(x, y), Vec2(-x, y)};
}

inline Polygon hexagon(double radius) {
  Polygon outline;
  for (int k = 0; k < 6; ++k) outline.push_back(common::Rotation(k * 1.0471975511965976) * Vec2(radius, 0));
  return outline;
}

struct Sums {
  double mass = 0;
  double area = 0;
  double kinetic_energy = 0;
  double angular_momentum = 0;  ///< about the origin
  Vec2 momentum = Vec2::Zero();
  Vec2 first_moment = Vec2::Zero();  ///< mass times centre of mass
};

inline Sums sums(const dem::Particles& p) {
  Sums s;
  for (std::size_t i = 0; i < p.size(); ++i) {
    s.mass += p.mass[i];
    s.area += p.area[i];
    s.momentum += p.mass[i] * p.velocity[i];
    s.first_moment += p.mass[i] * p.position[i];
    s.angular_momentum +=
        p.inertia[i] * p.angular_velocity[i] + p.mass[i] * common::cross(p.position[i], p.velocity[i]);
    s.kinetic_energy +=
        0.5 * (p.mass[i] * p.velocity[i].squaredNorm() + p.inertia[i] * p.angular_velocity[i] * p.angular_velocity[i]);
  }
  return s;
}

}  // namespace bodies
