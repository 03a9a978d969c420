#include "xfem/crack/dense_spd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

SpdCondition condition_of(DenseSymmetric matrix) {
  const int n = matrix.size;
  SpdCondition result;
  std::vector<double> scale(n), sums(n, 0.0);
  for (int i = 0; i < n; ++i) scale[i] = 1 / std::sqrt(matrix.at(i, i));
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) {
      matrix.at(i, j) *= scale[i] * scale[j];
      sums[i] += std::abs(matrix.at(i, j));
      if (j > i) sums[j] += std::abs(matrix.at(i, j));
    }
  }
  for (int k = 0; k < n; ++k) {
    const double pivot = matrix.at(k, k);
    if (!(pivot >= result.smallest_pivot)) {
      result.smallest_pivot = pivot;
      result.row = k;
    }
    if (!(pivot > 0)) {
      result.inverse_norm = result.condition = std::numeric_limits<double>::infinity();
      return result;
    }
    const double root = 1 / std::sqrt(pivot);
    for (int j = k; j < n; ++j) matrix.at(k, j) *= root;
    for (int i = k + 1; i < n; ++i) {
      for (int j = i; j < n; ++j) matrix.at(i, j) -= matrix.at(k, i) * matrix.at(k, j);
    }
  }
  const auto solve = [&](std::vector<double> x) {
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) x[i] -= matrix.at(k, i) * x[k];
      x[i] /= matrix.at(i, i);
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) x[i] -= matrix.at(i, k) * x[k];
      x[i] /= matrix.at(i, i);
    }
    return x;
  };
  constexpr int kSolutions = 5;
  std::vector<double> probe(n, 1.0 / n);
  int tried = -1;
  for (int solution = 0; solution < kSolutions; ++solution) {
    std::vector<double> x = solve(probe);
    double norm = 0;
    for (double& value : x) {
      norm += std::abs(value);
      value = value < 0 ? -1 : 1;
    }
    result.inverse_norm = std::max(result.inverse_norm, norm);
    const std::vector<double> gradient = solve(x);  // the matrix is symmetric
    const auto steepest = std::max_element(gradient.begin(), gradient.end(),
                                           [](double l, double r) { return std::abs(l) < std::abs(r); });
    const int next = static_cast<int>(steepest - gradient.begin());
    if (next == tried) break;
    tried = next;
    probe.assign(n, 0.0);
    probe[next] = 1;
  }
  result.condition = result.inverse_norm * *std::max_element(sums.begin(), sums.end());
  return result;
}

}  // namespace xfem
