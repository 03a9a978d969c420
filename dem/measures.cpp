#include "dem/measures.hpp"

#include <algorithm>
#include <cmath>

#include "common/math/arc_tangent.hpp"

namespace dem {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kInterior = 0.7;  // of the assembly's axes

/// True if the polygon of the ring centroids goes around `point` (crossings of the ray to the right).
bool inside_ring(const State& state, const Vec2& point) {
  const std::vector<Vec2>& at = state.particles.position;
  bool inside = false;
  for (std::size_t k = 0; k < state.ring.size(); ++k) {
    const Vec2& p = at[state.ring[k]];
    const Vec2& q = at[state.ring[k + 1 < state.ring.size() ? k + 1 : 0]];
    if ((p.y() > point.y()) == (q.y() > point.y())) continue;
    const double side = common::cross(q - p, point - p);
    if ((q.y() > p.y()) == (side > 0)) inside = !inside;
  }
  return inside;
}

/// Share of the way from p to q inside the unit circle.
double share_inside(const Vec2& p, const Vec2& q) {
  const Vec2 way = q - p;
  const double a = way.squaredNorm();
  const double b = p.dot(way);
  const double discriminant = b * b - a * (p.squaredNorm() - 1);
  if (!(discriminant > 0)) return 0;
  const double root = std::sqrt(discriminant);
  return std::max(0.0, std::min(1.0, (root - b) / a) - std::max(0.0, (-b - root) / a));
}

/// Interior angle at `at` of a counter-clockwise polygon, in [0, 2 pi).
double interior_angle(const Vec2& before, const Vec2& at, const Vec2& after) {
  const Vec2 out = after - at;
  const Vec2 in = before - at;
  const double angle = common::arc_tangent2(common::cross(out, in), out.dot(in));
  return angle < 0 ? angle + kTwoPi : angle;
}

}  // namespace

double ring_area(const State& state) {
  // Relative to the first centroid, so that the sum does not lose digits far from the origin.
  if (state.ring.size() < 3) return 0;
  const Vec2 origin = state.particles.position[state.ring[0]];
  double twice = 0;
  for (std::size_t k = 1; k + 1 < state.ring.size(); ++k) {
    twice += common::cross(state.particles.position[state.ring[k]] - origin,
                           state.particles.position[state.ring[k + 1]] - origin);
  }
  return 0.5 * twice;
}

VoidRatios void_ratios(const State& state) {
  const Particles& particles = state.particles;
  std::vector<std::uint8_t> in_ring(particles.size(), 0);
  for (const std::int32_t i : state.ring) in_ring[i] = 1;
  std::vector<std::uint8_t> held(particles.size(), 0);
  for (const Contact& contact : state.contacts) held[contact.a] = held[contact.b] = 1;
  double interior = 0;
  int escaped = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (in_ring[i]) continue;
    if (held[i] || inside_ring(state, particles.position[i])) {
      interior += particles.area[i];
    } else {
      ++escaped;
    }
  }
  double rim = 0;
  const std::size_t count = state.ring.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::int32_t before = state.ring[(k + count - 1) % count];
    const std::int32_t at = state.ring[k];
    const std::int32_t after = state.ring[(k + 1) % count];
    const double angle = interior_angle(particles.position[before], particles.position[at], particles.position[after]);
    rim += particles.area[at] * (angle / kTwoPi);
  }
  double overlaps = 0;
  for (const Contact& contact : state.contacts) overlaps += contact.overlap_area;

  const double total = ring_area(state);
  VoidRatios ratios;
  ratios.e1 = total / (interior + rim) - 1;
  ratios.e2 = total / (interior + rim - overlaps) - 1;
  ratios.e4 = total / interior - 1;
  ratios.escaped = escaped;
  return ratios;
}

std::array<double, 3> mean_stress(const State& state, double assembly_area) {
  double xx = 0, yy = 0, xy = 0;
  for (const Contact& contact : state.contacts) {
    const Vec2 force = contact.force();
    const Vec2 branch = state.particles.position[contact.b] - state.particles.position[contact.a];
    xx += force.x() * branch.x();
    yy += force.y() * branch.y();
    xy += 0.5 * (force.x() * branch.y() + force.y() * branch.x());
  }
  return {xx / assembly_area, yy / assembly_area, xy / assembly_area};
}

std::array<double, 3> interior_stress(const State& state, double assembly_area) {
  const std::vector<Vec2>& at = state.particles.position;
  const double count = static_cast<double>(state.ring.size());
  Vec2 middle = Vec2::Zero();
  for (const std::int32_t i : state.ring) middle += at[i] / count;
  Vec2 spread = Vec2::Zero();
  for (const std::int32_t i : state.ring) spread += (at[i] - middle).cwiseAbs2();
  // An ellipse of the assembly's area whose axes are as those of the ring.
  const double aspect = std::sqrt(spread.x() / spread.y());
  const double radius = kInterior * std::sqrt(2 * assembly_area / kTwoPi);
  const Vec2 scale(1 / (radius * std::sqrt(aspect)), std::sqrt(aspect) / radius);

  double xx = 0, yy = 0, xy = 0;
  for (const Contact& contact : state.contacts) {
    const Vec2 from = at[contact.a] - middle;
    const Vec2 to = at[contact.b] - middle;
    const double share = share_inside(from.cwiseProduct(scale), to.cwiseProduct(scale));
    if (share == 0) continue;
    const Vec2 force = share * contact.force();
    const Vec2 branch = to - from;
    xx += force.x() * branch.x();
    yy += force.y() * branch.y();
    xy += 0.5 * (force.x() * branch.y() + force.y() * branch.x());
  }
  const double area = kInterior * kInterior * assembly_area;
  return {xx / area, yy / area, xy / area};
}

}  // namespace dem
