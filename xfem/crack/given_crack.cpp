#include "xfem/crack/given_crack.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "common/error.hpp"
#include "common/geometry/vec2.hpp"
#include "xfem/crack/stress_intensity.hpp"

namespace xfem {
namespace {

using common::cross;

constexpr double kShortest = 1.5;  ///< length that a crack must have, in element sizes
/// How far the line goes on beyond an inner end to find edges to end on, in element sizes.
constexpr double kReach = 1.5;
/// Sideways offsets of each end that are tried: up to this many steps either way.
constexpr int kOffsets = 6;
constexpr double kOffsetStep = 0.05;  ///< in element sizes
/// What the square of an offset (in element sizes) and of the line's turn (radians) cost beside the square of a
/// mismatch in length (in element sizes). A turn is dear: a disc's K_II grows by 4 of its K_I per radian.
constexpr double kLargestMismatch = 0.6;  ///< in element sizes
constexpr double kOffsetCost = 0.25, kTurnCost = 150;

/// Distance from a point along a unit vector to the boundary of a convex outline; 0 if the point is not inside.
double room(PolygonView outline, const Vec2& from, const Vec2& along) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    const double depth = cross(edge, from - outline[i]);
    if (!(depth > 0)) return 0;
    const double outward = cross(along, edge);
    if (outward > 0) nearest = std::min(nearest, depth / outward);
  }
  return nearest;
}

struct Candidate {
  Crack crack;
  double cost = std::numeric_limits<double>::infinity();
};

/// Cuts the crack's end back to the inner edge where its effective tip is nearest to `target`; returns how far the tip
/// is then beyond it, in element sizes. `outward` points along the line out of this end.
double cut_back(const Mesh& mesh, Crack& crack, int end, const Vec2& target, const Vec2& outward) {
  auto& points = crack.points;
  double best = std::numeric_limits<double>::infinity();
  std::size_t keep = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (on_boundary(mesh, points[i])) continue;
    const double size = element_size(mesh, points[i]);
    const double beyond = (points[i].position - target).dot(outward) / size - kTipShift;
    if (std::abs(beyond) >= std::abs(best)) continue;
    best = beyond;
    keep = i;
  }
  if (!std::isfinite(best)) return best;
  if (end == 1) {
    points.resize(keep + 1);
  } else {
    points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(keep));
  }
  crack.tips[end] = TipState::active;
  return best;
}

}  // namespace

Crack place_given_crack(const Mesh& mesh, PolygonView outline, const Vec2& from, const Vec2& to) {
  const std::array<Vec2, 2> ends{from, to};
  const Vec2 along = (to - from) / (to - from).norm();
  const Vec2 left = common::perpendicular(along);
  std::array<TipState, 2> tips;
  for (int end = 0; end < 2; ++end) {
    tips[end] = room(outline, ends[end], along) > 0 ? TipState::active : TipState::at_boundary;
  }
  const auto text = [](const Vec2& p) { return "[" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + "]"; };
  if (tips[0] == TipState::at_boundary && tips[1] == TipState::at_boundary) {
    throw common::bad_input("crack from " + text(from) + " to " + text(to) +
                            " m: found both ends on or outside the boundary, expected at least one inside");
  }
  Candidate best;
  for (int i = -kOffsets; i <= kOffsets; ++i) {
    for (int j = -kOffsets; j <= kOffsets; ++j) {
      const double first = i * kOffsetStep;
      const double last = j * kOffsetStep;
      const double turn = (last - first) * mesh.size / (to - from).norm();
      std::array<Vec2, 2> line{from + first * mesh.size * left, to + last * mesh.size * left};
      const Vec2 direction = (line[1] - line[0]) / (line[1] - line[0]).norm();
      bool inside = true;
      for (int end = 0; end < 2; ++end) {
        if (tips[end] == TipState::at_boundary) continue;
        const Vec2 outward = end == 1 ? direction : Vec2(-direction);
        const double free = room(outline, line[end], outward);
        inside = inside && free > 0;
        line[end] += std::min(kReach * mesh.size, 0.999 * free) * outward;
      }
      if (!inside) continue;
      Candidate trial{place_polyline(mesh, line, tips),
                      kOffsetCost * (first * first + last * last) + kTurnCost * turn * turn};
      double sum = 0;
      for (int end = 0; end < 2; ++end) {
        if (tips[end] == TipState::at_boundary) continue;
        const double beyond = cut_back(mesh, trial.crack, end, ends[end], end == 1 ? along : Vec2(-along));
        inside = inside && std::abs(beyond) < kLargestMismatch;
        trial.cost += beyond * beyond;
        sum += beyond;
      }
      trial.cost += sum * sum;
      if (!inside || trial.crack.points.size() < 4 || !(trial.cost < best.cost)) continue;
      best = std::move(trial);
    }
  }
  if (best.crack.points.empty() || (to - from).norm() < kShortest * mesh.size) {
    throw common::bad_input("crack from " + text(from) + " to " + text(to) +
                            " m: found fewer than three elements along it, expected a longer crack or a finer mesh");
  }
  return best.crack;
}

}  // namespace xfem
