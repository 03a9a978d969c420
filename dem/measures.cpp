#include "dem/measures.hpp"

#include <algorithm>

#include "common/math/arc_tangent.hpp"

namespace dem {
namespace {

constexpr double kTwoPi = 6.283185307179586;

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
  double interior = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!particles.boundary[i]) interior += particles.area[i];
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

Vec2 ring_extent(const State& state) {
  if (state.ring.empty()) return Vec2::Zero();
  Vec2 low = state.particles.position[state.ring[0]];
  Vec2 high = low;
  for (const std::int32_t i : state.ring) {
    const Vec2& p = state.particles.position[i];
    low = {std::min(low.x(), p.x()), std::min(low.y(), p.y())};
    high = {std::max(high.x(), p.x()), std::max(high.y(), p.y())};
  }
  return high - low;
}

}  // namespace dem
