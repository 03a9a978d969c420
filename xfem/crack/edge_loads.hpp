// Loads on the enriched dofs: contact forces on a cut boundary edge and the body force of the inertia relief.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// Body force of the rigid acceleration that balances the loads, b(x) = translation + rotation * perp(x - center).
struct BodyForce {
  Vec2 center;       ///< area centroid [m]
  Vec2 translation;  ///< - F / A [N/m^2, unit thickness]
  double rotation;   ///< - M / Ip [N/m^3]
};
BodyForce inertia_relief(const Mesh& mesh, std::span<const Load> loads);

/// Integral over a convex part of an element of N b, with N(x) = 1/3 + gradient . (x - element_center). Exact.
Vec2 integrate_body_force(PolygonView part, double area, const Vec2& gradient, const Vec2& element_center,
                          const BodyForce& body);

/// Sum of N_J f of the loads that act on a boundary edge beyond the mouth at `fraction`, as seen from node J, which is
/// edge[0] (`at_start`) or edge[1]. Loads act at the nearest boundary point; `patch` > 0 spreads each evenly over that
/// length along the boundary.
Vec2 edge_force_beyond(const Mesh& mesh, const std::array<int, 2>& edge, double fraction, bool at_start,
                       std::span<const Load> loads, double patch);

}  // namespace xfem
