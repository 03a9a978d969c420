// What the stiffness of T3 elements is made of, and how it is supported.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// Constant gradients of the shape functions of every element [1/m]: grad N_k = perpendicular(edge opposite to k) / (2
/// A).
std::vector<ElementGradients> element_gradients(const Mesh& mesh);

/// Three dofs, ascending, whose fixing is statically determinate: both of the boundary node farthest from the
/// centroid, and of the boundary node farthest from that one the dof more perpendicular to the line between them.
std::array<int, 3> determinate_supports(const Mesh& mesh);

}  // namespace xfem
