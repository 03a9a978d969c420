// Rigid platens with Coulomb friction on two opposite faces of an uncracked block.
#pragma once

#include <vector>

#include "xfem/lab/tractions.hpp"

namespace xfem {

/// Nodal forces of two rigid platens that close in along y without turning or moving sideways and carry `load` [N/m]
/// together. Unknown are the normal and tangential forces p_i, t_i of the faces' nodes, the closing and the block's
/// rigid motion; known are the nodes' compliances, by one solve of the intact model for each. At each node
///   normal:      same displacement for all nodes of a face that touch (p_i >= 0), p_i = 0 where a gap opens;
///   tangential:  no displacement (|t_i| <= friction p_i), or t_i = +-friction p_i against the displacement;
/// with the balance of forces and moments, a linear system for each choice of who touches and who slips. The choice is
/// iterated from "all touch, all stick" until no node contradicts it. The result is proportional to the load, so it
/// holds for a load that only grows; cracks that grow later do not change it.
/// Throws numerical_failure if the choice does not settle.
std::vector<Load> platen_forces(const IntactModel& model, const Face& bottom, const Face& top, double friction,
                                double load);

}  // namespace xfem
