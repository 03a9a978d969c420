#include "xfem/elasticity/loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace xfem {
namespace {

/// A straight piece of a patch, arc length measured from the patch's middle.
struct Piece {
  int edge;
  double from, to;              ///< arc length
  double position, per_length;  ///< position on the edge at `from`, and its growth with arc length
};

std::vector<Piece> pieces_of(std::span<const Vec2> loop, const BoundaryLoop::Foot& middle, double& patch) {
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

BoundaryLoop::BoundaryLoop(std::span<const Vec2> points) : edges_(points.size()), data_(5 * points.size()) {
  for (std::size_t k = 0; k < edges_; ++k) {
    const Vec2 edge = points[(k + 1) % edges_] - points[k];
    data_[k] = points[k].x();
    data_[edges_ + k] = points[k].y();
    data_[2 * edges_ + k] = edge.x();
    data_[3 * edges_ + k] = edge.y();
    data_[4 * edges_ + k] = edge.squaredNorm();
  }
}

BoundaryLoop::Foot BoundaryLoop::nearest(const Vec2& point) const {
  constexpr std::size_t kChunk = 64;
  std::array<double, kChunk> position, distance;
  const double px = point.x(), py = point.y();
  const double *x = data_.data(), *y = x + edges_, *ex = y + edges_, *ey = ex + edges_, *squared = ey + edges_;
  int edge = -1;
  double along = 0, least = 0;
  for (std::size_t first = 0; first < edges_; first += kChunk) {
    const std::size_t count = std::min(kChunk, edges_ - first);
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t k = first + j;
      const double dx = px - x[k], dy = py - y[k];
      double t = (dx * ex[k] + dy * ey[k]) / squared[k];
      t = t < 0 ? 0 : t;
      t = t > 1 ? 1 : t;
      const double rx = dx - t * ex[k], ry = dy - t * ey[k];
      position[j] = t;
      distance[j] = rx * rx + ry * ry;
    }
    for (std::size_t j = 0; j < count; ++j) {
      // The margin makes equal distances fall on the first edge whatever the rounding, on the mesh and on the outline.
      if (edge >= 0 && !(distance[j] < least * (1 - 1e-9))) continue;
      edge = static_cast<int>(first + j);
      along = position[j];
      least = distance[j];
    }
  }
  return {edge, along, {x[edge] + along * ex[edge], y[edge] + along * ey[edge]}};
}

std::vector<BoundaryShare> boundary_shares(std::span<const Vec2> loop, const Load& load, double patch) {
  return boundary_shares(loop, BoundaryLoop(loop), load, patch);
}

std::vector<BoundaryShare> boundary_shares(std::span<const Vec2> loop, const BoundaryLoop& feet, const Load& load,
                                           double patch) {
  const BoundaryLoop::Foot middle = feet.nearest(load.point);
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

std::vector<Vec2> boundary_forces(std::span<const Vec2> points, const BoundaryLoop& loop, std::span<const Load> loads,
                                  double patch) {
  std::vector<Vec2> forces(points.size(), Vec2::Zero());
  for (const Load& load : loads) {
    for (const BoundaryShare& share : boundary_shares(points, loop, load, patch)) {
      forces[share.edge] += (1 - share.position) * share.weight * load.force;
      forces[(share.edge + 1) % points.size()] += share.position * share.weight * load.force;
    }
  }
  return forces;
}

BodyForce balancing_body_force(std::span<const Vec2> loop, std::span<const Vec2> forces, const AreaMoments& moments) {
  Vec2 resultant = Vec2::Zero();
  double moment = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    resultant += forces[k];
    moment += common::cross(loop[k] - moments.center, forces[k]);
  }
  return {moments.center, resultant / moments.area, moment / moments.polar};
}

}  // namespace xfem
