// Factorization of the stiffness of a T3 mesh, once in a particle's life.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

/// L D L' of the stiffness in 2 x 2 blocks of nodes, ordered by AMD (approximate minimum degree) on the graph of the
/// nodes. Fixed dofs are rows and columns of the identity. No BLAS: its bits do not depend on the machine. Solving is
/// thread-safe.
class Factor {
 public:
  /// Throws numerical_failure if the stiffness is not positive definite.
  Factor(const Mesh& mesh, const std::vector<ElementGradients>& gradients, const Eigen::Matrix3d& elasticity,
         const std::array<int, 3>& fixed_dofs);

  /// Displacements (2 n x k) of forces (2 n x k); forces on the fixed dofs are ignored, their displacements are zero.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& forces) const;

  /// The same in place for `Width` = 1, 2, 4 or 8 columns side by side, x[dof * Width + column]. Each column's
  /// operations are the same for any width; where a node's forces are zero nothing is subtracted, so that a few forces
  /// cost only the rows that they reach.
  template <int Width>
  void solve_side_by_side(double* x) const;

 private:
  std::array<int, 3> fixed_dofs_;
  std::vector<int> node_;          ///< n: nodes in order of elimination
  std::vector<int> column_, row_;  ///< column starts of the strictly lower blocks of L, and their nodes
  std::vector<double> value_;      ///< 4 per block, row by row
  std::vector<double> inverse_;    ///< 4 per node in order: inverse of D
};

}  // namespace xfem
