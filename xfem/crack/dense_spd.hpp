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

/// Pivot of a matrix with unit diagonal below which it is singular to within rounding.
inline constexpr double kSmallestPivot = 1e-8;

/// Solves A x = b by Cholesky (U^T U) after scaling the diagonal to 1 (Jacobi), which makes the condition of an XFEM
/// system independent of how small the cut parts are. Empty if a pivot falls below `smallest_pivot`, or if the scaled x
/// is larger than the scaled b by more than its inverse: A is singular to within rounding.
std::optional<Eigen::VectorXd> solve_spd(DenseSymmetric matrix, const Eigen::VectorXd& right,
                                         double smallest_pivot = kSmallestPivot);

/// Why a system was not solved, in numbers.
struct SpdCondition {
  double smallest_pivot = 1;  ///< of the scaled matrix, up to the first that is not positive; its smallest eigenvalue
                              ///< is no larger, so that its condition is at least 1 / smallest_pivot
  int row = -1;               ///< of that pivot
  double inverse_norm = 0;    ///< 1-norm of the inverse of the scaled matrix, Hager's estimate (a lower bound);
                              ///< infinite without a factor
  double condition = 0;       ///< of the scaled matrix in the 1-norm
};

/// Hager 1984, Higham 1988: the 1-norm of an inverse from a few solutions with its factor. For messages: it costs about
/// as much as the solution.
SpdCondition condition_of(DenseSymmetric matrix);

}  // namespace xfem
