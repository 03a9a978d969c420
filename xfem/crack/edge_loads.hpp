// Loads on the enriched dofs: contact forces on a cut boundary edge and the body force of the inertia relief.
#pragma once

#include <span>

#include "xfem/crack/path.hpp"
#include "xfem/elasticity/intact_model.hpp"
#include "xfem/elasticity/loads.hpp"

namespace xfem {

/// Body force that balances the loads (inertia relief), b(x) = -(linear + angular * perpendicular(x - center)).
struct BodyForce {
  Vec2 center;  ///< area centroid [m]
  RigidAcceleration acceleration;
};
BodyForce inertia_relief(const Mesh& mesh, std::span<const Load> loads, double patch);

/// Integral over a convex part of an element of N b, with N(x) = 1/3 + gradient . (x - element_center). Exact.
Vec2 integrate_body_force(PolygonView part, double area, const Vec2& gradient, const Vec2& element_center,
                          const BodyForce& body);

/// Sum of N_J f of the loads that act on a mouth's boundary edge beyond the mouth as seen from `node`, one of the
/// edge's ends J. Loads act and spread as in IntactModel::nodal_forces; a patch across the mouth is divided there.
Vec2 force_beyond_mouth(const Mesh& mesh, const CrackPoint& mouth, int node, std::span<const Load> loads, double patch);

}  // namespace xfem
