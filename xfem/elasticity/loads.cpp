#include "xfem/elasticity/loads.hpp"

#include <algorithm>
#include <cmath>

namespace xfem {
namespace {

struct LoopPoint {
  int edge;
  double position;
  Vec2 point;
};

LoopPoint nearest_point(std::span<const Vec2> loop, const Vec2& point) {
  LoopPoint nearest{-1, 0, point};
  double least = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& from = loop[k];
    const Vec2 edge = loop[(k + 1) % loop.size()] - from;
    const double t = std::clamp((point - from).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const Vec2 foot = from + t * edge;
    const double distance = (point - foot).squaredNorm();
    // The margin makes equal distances fall on the first edge whatever the rounding, on the mesh and on the outline.
    if (nearest.edge < 0 || distance < least * (1 - 1e-9)) {
      nearest = {static_cast<int>(k), t, foot};
      least = distance;
    }
  }
  return nearest;
}

/// A straight piece of a patch, arc length measured from the patch's middle.
struct Piece {
  int edge;
  double from, to;              ///< arc length
  double position, per_length;  ///< position on the edge at `from`, and its growth with arc length
};

std::vector<Piece> pieces_of(std::span<const Vec2> loop, const LoopPoint& middle, double& patch) {
  const std::size_t n = loop.size();
  std::vector<double> start(n + 1, 0.0);
  for (std::size_t k = 0; k < n; ++k) start[k + 1] = start[k] + (loop[(k + 1) % n] - loop[k]).norm();
  const double perimeter = start[n];
  patch = std::min(patch, perimeter);
  const double center = start[middle.edge] + middle.position * (start[middle.edge + 1] - start[middle.edge]);
  std::vector<Piece> pieces;
  for (const double turn : {-perimeter, 0.0, perimeter}) {
    for (std::size_t k = 0; k < n; ++k) {
      const double edge_start = start[k] + turn - center;
      const double length = start[k + 1] - start[k];
      const double from = std::max(edge_start, -0.5 * patch);
      const double to = std::min(edge_start + length, 0.5 * patch);
      if (to > from) pieces.push_back({static_cast<int>(k), from, to, (from - edge_start) / length, 1 / length});
    }
  }
  return pieces;
}

}  // namespace

std::vector<BoundaryShare> boundary_shares(std::span<const Vec2> loop, const Load& load, double patch) {
  const LoopPoint middle = nearest_point(loop, load.point);
  if (patch <= 0) return {{middle.edge, middle.position, 1.0}};

  std::vector<BoundaryShare> shares;
  std::vector<double> arc;
  double moment = 0, moment_of_slope = 0;
  for (const Piece& piece : pieces_of(loop, middle, patch)) {
    const Vec2& from = loop[piece.edge];
    const Vec2 edge = loop[(piece.edge + 1) % loop.size()] - from;
    const double length = piece.to - piece.from;
    for (const double u : {0.0, 0.5, 1.0}) {
      const double s = piece.from + u * length;
      const double position = std::clamp(piece.position + u * length * piece.per_length, 0.0, 1.0);
      const double weight = (u == 0.5 ? 4.0 : 1.0) / 6 * length / patch;
      shares.push_back({piece.edge, position, weight});
      arc.push_back(s);
      const double lever = common::cross(from + position * edge - middle.point, load.force);
      moment += weight * lever;
      moment_of_slope += weight * s * lever;
    }
  }
  double slope = 0;
  if (std::abs(moment) > 1e-14 * load.force.norm() * patch) {
    const double limit = 2 / patch;  // the density stays positive
    slope = std::abs(moment) < limit * std::abs(moment_of_slope) ? -moment / moment_of_slope
                                                                 : (moment * moment_of_slope > 0   ? -limit
                                                                    : moment * moment_of_slope < 0 ? limit
                                                                                                   : 0.0);
  }
  for (std::size_t k = 0; k < shares.size(); ++k) shares[k].weight *= 1 + slope * arc[k];
  return shares;
}

std::vector<Vec2> boundary_forces(std::span<const Vec2> loop, std::span<const Load> loads, double patch) {
  std::vector<Vec2> forces(loop.size(), Vec2::Zero());
  for (const Load& load : loads) {
    for (const BoundaryShare& share : boundary_shares(loop, load, patch)) {
      forces[share.edge] += (1 - share.position) * share.weight * load.force;
      forces[(share.edge + 1) % loop.size()] += share.position * share.weight * load.force;
    }
  }
  return forces;
}

RigidAcceleration rigid_acceleration(std::span<const Vec2> loop, std::span<const Vec2> forces, double area,
                                     const Vec2& center, double polar_moment) {
  Vec2 resultant = Vec2::Zero();
  double moment = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    resultant += forces[k];
    moment += common::cross(loop[k] - center, forces[k]);
  }
  return {resultant / area, moment / polar_moment};
}

}  // namespace xfem
