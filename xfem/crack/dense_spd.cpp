#include "xfem/crack/dense_spd.hpp"

#include <cmath>

namespace xfem {

std::optional<Eigen::VectorXd> solve_spd(DenseSymmetric matrix, const Eigen::VectorXd& right, double smallest_pivot) {
  const int n = matrix.size;
  std::vector<double> scale(n);
  for (int i = 0; i < n; ++i) {
    if (!(matrix.at(i, i) > 0)) return std::nullopt;
    scale[i] = 1 / std::sqrt(matrix.at(i, i));
  }
  Eigen::VectorXd x(n);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) matrix.at(i, j) *= scale[i] * scale[j];
    x[i] = right[i] * scale[i];
  }
  for (int k = 0; k < n; ++k) {
    double* row = &matrix.at(k, 0);
    if (!(row[k] > smallest_pivot)) return std::nullopt;
    const double root = 1 / std::sqrt(row[k]);
    for (int j = k; j < n; ++j) row[j] *= root;
    for (int i = k + 1; i < n; ++i) {
      double* target = &matrix.at(i, 0);
      const double factor = row[i];
      for (int j = i; j < n; ++j) target[j] -= factor * row[j];
    }
  }
  for (int i = 0; i < n; ++i) {
    x[i] /= matrix.at(i, i);
    for (int j = i + 1; j < n; ++j) x[j] -= matrix.at(i, j) * x[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) x[i] -= matrix.at(i, j) * x[j];
    x[i] /= matrix.at(i, i);
  }
  for (int i = 0; i < n; ++i) x[i] *= scale[i];
  return x;
}

}  // namespace xfem
