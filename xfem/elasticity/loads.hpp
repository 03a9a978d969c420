// Contact forces as forces on the points of a closed boundary polyline, and the rigid motion that balances them.
// The polyline is the boundary of a mesh or the outline itself: edge loads with linear shape functions have the same
// resultant, moment and virial on both.
#pragma once

#include <span>
#include <vector>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// A closed polyline, prepared for finding the point of it that is nearest to another.
class BoundaryLoop {
 public:
  BoundaryLoop() = default;
  explicit BoundaryLoop(std::span<const Vec2> points);

  struct Foot {
    int edge;         ///< from point `edge` to its successor
    double position;  ///< along the edge, in [0, 1]
    Vec2 point;
  };
  /// Of equally near points the first.
  Foot nearest(const Vec2& point) const;

 private:
  std::size_t edges_ = 0;
  std::vector<double> data_;  ///< 5 x edges: start x, y, edge x, y, squared length
};

/// A share of a load at a point of the boundary edge from point `edge` to its successor.
struct BoundaryShare {
  int edge;
  double position;  ///< along the edge, in [0, 1]
  double weight;    ///< of the load's force; the weights of a load sum to 1
};

/// Where a load acts: at the nearest point p of the closed polyline `loop` (of equally near ones the first), or spread
/// over a length `patch` [m] of it about p with the density (1 + c s) / patch, s the arc length from p. c keeps the
/// moment of the force at p when the patch bends round a corner, as far as the density stays positive; on a straight
/// edge c = 0. The shares are Simpson points, exact for linear shape functions.
std::vector<BoundaryShare> boundary_shares(std::span<const Vec2> points, const BoundaryLoop& loop, const Load& load,
                                           double patch);
std::vector<BoundaryShare> boundary_shares(std::span<const Vec2> loop, const Load& load, double patch);

/// Forces on the points of the loop [N]: each share divided between the two ends of its edge.
std::vector<Vec2> boundary_forces(std::span<const Vec2> points, const BoundaryLoop& loop, std::span<const Load> loads,
                                  double patch);

/// Area, centroid and polar moment of area about it.
struct AreaMoments {
  double area;   ///< [m^2]
  Vec2 center;   ///< [m]
  double polar;  ///< [m^4]
};

/// Area, centroid and second moments of area about it.
struct SecondMoments {
  double area;        ///< [m^2]
  Vec2 center;        ///< [m]
  double xx, yy, xy;  ///< integrals of x x, y y, x y [m^4]
};
SecondMoments second_moments(PolygonView outline);

/// The mean stress of a body under forces at points and the body force that balances them,
/// sigma = -(sum f (x) x + integral b (x) x) / A, symmetric part, compression positive.
class Virial {
 public:
  explicit Virial(const SecondMoments& moments) : moments_(moments) {}
  void add(const Vec2& point, const Vec2& force) {
    const Vec2 x = point - moments_.center;
    xx_ += force.x() * x.x();
    yy_ += force.y() * x.y();
    xy_ += 0.5 * (force.x() * x.y() + force.y() * x.x());
    moment_ += common::cross(x, force);
  }
  Stress stress() const;

 private:
  const SecondMoments& moments_;
  double xx_ = 0, yy_ = 0, xy_ = 0, moment_ = 0;
};

/// The body force that balances forces on the points of the loop.
BodyForce balancing_body_force(std::span<const Vec2> loop, std::span<const Vec2> forces, const AreaMoments& moments);

}  // namespace xfem
