#include "xfem/crack/dense_lu.hpp"

#include <algorithm>
#include <cmath>

namespace xfem {

DenseLu::DenseLu(int size, std::vector<double> values) : size_(size), values_(std::move(values)), pivot_(size) {
  constexpr double kSmallestPivot = 1e-13;
  const int n = size_;
  double largest = 0;
  for (const double value : values_) largest = std::max(largest, std::abs(value));
  const auto row = [&](int i) { return values_.data() + static_cast<std::size_t>(i) * n; };
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(row(i)[k]) > std::abs(row(best)[k])) best = i;
    }
    pivot_[k] = best;
    if (!(std::abs(row(best)[k]) > kSmallestPivot * largest)) {
      is_singular_ = true;
      return;
    }
    if (best != k) std::swap_ranges(row(k), row(k) + n, row(best));
    const double* __restrict upper = row(k);
    for (int i = k + 1; i < n; ++i) {
      double* __restrict lower = row(i);
      const double factor = lower[k] /= upper[k];
      if (factor == 0) continue;
      for (int j = k + 1; j < n; ++j) lower[j] -= factor * upper[j];
    }
  }
}

void DenseLu::solve(std::span<double> b) const {
  const int n = size_;
  for (int k = 0; k < n; ++k) std::swap(b[k], b[pivot_[k]]);
  for (int i = 0; i < n; ++i) {
    const double* row = values_.data() + static_cast<std::size_t>(i) * n;
    for (int j = 0; j < i; ++j) b[i] -= row[j] * b[j];
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = values_.data() + static_cast<std::size_t>(i) * n;
    for (int j = i + 1; j < n; ++j) b[i] -= row[j] * b[j];
    b[i] /= row[i];
  }
}

}  // namespace xfem
