#include "xfem/crack/dense_spd.hpp"

#include <algorithm>
#include <cmath>

namespace xfem {
namespace {

/// target[j] -= sum of factor[p] * row[p][j] over the `Count` rows, in this order for each j.
template <int Count>
void subtract_rows(double* __restrict target, const double* rows, int stride, const double* factor, int from, int to) {
  const double* __restrict row[Count];
  double own[Count];
  for (int p = 0; p < Count; ++p) {
    row[p] = rows + static_cast<std::size_t>(p) * stride;
    own[p] = factor[p];
  }
  for (int j = from; j < to; ++j) {
    double value = target[j];
    for (int p = 0; p < Count; ++p) value -= own[p] * row[p][j];
    target[j] = value;
  }
}

/// Four sums in a fixed order, so that they run side by side.
double dot(const double* a, const double* b, int from, int to) {
  double sum[4] = {0, 0, 0, 0};
  int j = from;
  for (; j + 4 <= to; j += 4) {
    for (int k = 0; k < 4; ++k) sum[k] += a[j + k] * b[j + k];
  }
  for (int k = 0; j < to; ++j, ++k) sum[k] += a[j] * b[j];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

std::optional<Eigen::VectorXd> solve_spd(DenseSymmetric matrix, const Eigen::VectorXd& right, double smallest_pivot) {
  const int n = matrix.size;
  std::vector<double> scale(n);
  for (int i = 0; i < n; ++i) {
    if (!(matrix.at(i, i) > 0)) return std::nullopt;
    scale[i] = 1 / std::sqrt(matrix.at(i, i));
  }
  Eigen::VectorXd x(n);
  for (int i = 0; i < n; ++i) {
    double* row = &matrix.at(i, 0);
    for (int j = i; j < n; ++j) row[j] *= scale[i] * scale[j];
    x[i] = right[i] * scale[i];
  }
  // U^T U, four rows of U at a time; each entry sees the rows above it in ascending order.
  constexpr int kPanel = 4;
  for (int first = 0; first < n; first += kPanel) {
    const int last = std::min(first + kPanel, n);
    const double* panel = &matrix.at(first, 0);
    for (int k = first; k < last; ++k) {
      double* row = &matrix.at(k, 0);
      for (int p = first; p < k; ++p) {
        const double factor = matrix.at(p, k);
        subtract_rows<1>(row, &matrix.at(p, 0), n, &factor, k, n);
      }
      if (!(row[k] > smallest_pivot)) return std::nullopt;
      const double root = 1 / std::sqrt(row[k]);
      for (int j = k; j < n; ++j) row[j] *= root;
    }
    for (int i = last; i < n; ++i) {
      const double factor[kPanel] = {panel[i], panel[n + i], panel[2 * n + i], panel[3 * n + i]};
      subtract_rows<kPanel>(&matrix.at(i, 0), panel, n, factor, i, n);
    }
  }
  double largest_right = 0, largest = 0;
  for (int i = 0; i < n; ++i) {
    largest_right = std::max(largest_right, std::abs(x[i]));
    x[i] /= matrix.at(i, i);
    const double factor = x[i];
    subtract_rows<1>(x.data(), &matrix.at(i, 0), n, &factor, i + 1, n);
  }
  for (int i = n - 1; i >= 0; --i) {
    x[i] = (x[i] - dot(&matrix.at(i, 0), x.data(), i + 1, n)) / matrix.at(i, i);
  }
  for (int i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(x[i]));
    x[i] *= scale[i];
  }
  // A pivot tells a singular matrix only roughly; a solution that has grown beyond its digits tells the rest.
  if (!(smallest_pivot * largest <= largest_right)) return std::nullopt;
  return x;
}

}  // namespace xfem
