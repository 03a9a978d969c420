// Stiffness of T3 elements and its factorization, once in a particle's life.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// Constant gradients of the shape functions of every element [1/m]: grad N_k = perpendicular(edge opposite to k) / (2
/// A).
std::vector<ElementGradients> element_gradients(const Mesh& mesh);

/// Strain-displacement matrix B (3 x 6) of (xx, yy, 2 xy) for the dofs (u0, v0, u1, v1, u2, v2) [1/m].
Eigen::Matrix<double, 3, 6> strain_matrix(const ElementGradients& gradients);

/// Three dofs, ascending, whose fixing is statically determinate: both of the boundary node farthest from the
/// centroid, and of the boundary node farthest from that one the dof more perpendicular to the line between them.
std::array<int, 3> determinate_supports(const Mesh& mesh);

/// L D L' of the stiffness without the fixed dofs, in plain arrays. Made by CHOLMOD's simplicial method (AMD ordering,
/// no BLAS), so that its bits do not depend on the machine; solving needs no workspace of CHOLMOD and is thread-safe.
class Factor {
 public:
  /// Throws numerical_failure if the stiffness is not positive definite.
  Factor(const Mesh& mesh, const std::vector<ElementGradients>& gradients, const Eigen::Matrix3d& elasticity,
         const std::array<int, 3>& fixed_dofs);

  /// Displacements (2 n x k) of forces (2 n x k); forces on the fixed dofs are ignored, their displacements are zero.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& forces) const;

 private:
  std::vector<int> dof_;               ///< global dof of each row of L
  std::vector<int> column_, row_;      ///< column starts of the strictly lower part of L, and its rows
  std::vector<double> value_, pivot_;  ///< entries of L, and of D
};

}  // namespace xfem
