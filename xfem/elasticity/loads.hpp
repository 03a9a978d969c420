// Contact forces as forces on the points of a closed boundary polyline, and the rigid motion that balances them.
// The polyline is the boundary of a mesh or the outline itself: edge loads with linear shape functions have the same
// resultant, moment and virial on both.
#pragma once

#include <span>
#include <vector>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

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
std::vector<BoundaryShare> boundary_shares(std::span<const Vec2> loop, const Load& load, double patch);

/// Forces on the points of the loop [N]: each share divided between the two ends of its edge.
std::vector<Vec2> boundary_forces(std::span<const Vec2> loop, std::span<const Load> loads, double patch);

/// Body force per unit area, acceleration + rotation * perpendicular(x - center), that balances boundary forces.
struct RigidAcceleration {
  Vec2 linear;     ///< [N/m^2]
  double angular;  ///< [N/m^3]
};

/// Acceleration of a body of unit density under forces on the points of the loop.
RigidAcceleration rigid_acceleration(std::span<const Vec2> loop, std::span<const Vec2> forces, double area,
                                     const Vec2& center, double polar_moment);

}  // namespace xfem
