// Loads on the plane faces of a block.
#pragma once

#include <array>
#include <vector>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// A side of a block that is aligned with the axes: the mesh edges with coordinate `axis` (0: x, 1: y) at `level`.
struct Face {
  int axis;
  double level;  ///< [m]
};

/// Nodes of a face, ascending.
std::vector<int> face_nodes(const Mesh& mesh, const Face& face);

/// Adds the consistent nodal forces of a uniform pressure [Pa] (compression positive: it acts inwards; the block's
/// centre is the origin).
void add_pressure(const Mesh& mesh, const Face& face, double pressure, std::vector<Load>& loads);

}  // namespace xfem
