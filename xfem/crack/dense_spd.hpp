// Small dense symmetric positive definite systems, with the same bits on every machine: no blocked kernels whose order
// of summation follows the cache sizes of the host.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace xfem {

/// A symmetric matrix of `size` rows; only the upper triangle (row <= column) is used. Row-major.
struct DenseSymmetric {
  explicit DenseSymmetric(int rows) : size(rows), values(static_cast<std::size_t>(rows) * rows, 0.0) {}
  double& at(int row, int column) { return values[static_cast<std::size_t>(row) * size + column]; }
  double at(int row, int column) const { return values[static_cast<std::size_t>(row) * size + column]; }
  int size;
  std::vector<double> values;
};

/// Solves A x = b by Cholesky (U^T U) after scaling the diagonal to 1 (Jacobi), which makes the condition of an XFEM
/// system independent of how small the cut parts are. Empty if a pivot falls below `smallest_pivot`, or if the scaled x
/// is larger than the scaled b by more than its inverse: A is singular to within rounding.
std::optional<Eigen::VectorXd> solve_spd(DenseSymmetric matrix, const Eigen::VectorXd& right,
                                         double smallest_pivot = 1e-8);

}  // namespace xfem
