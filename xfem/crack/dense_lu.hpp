// Small dense systems that are not symmetric, with the same bits on every machine (see dense_spd.hpp).
#pragma once

#include <span>
#include <utility>
#include <vector>

namespace xfem {

/// L U = P A with partial pivoting, A of `size` rows, row by row.
class DenseLu {
 public:
  DenseLu(int size, std::vector<double> values);

  /// A pivot fell below 1e-13 of the largest entry: A is singular to within rounding.
  bool is_singular() const { return is_singular_; }
  /// Overwrites b by the solution of A x = b. Precondition: not singular.
  void solve(std::span<double> b) const;

 private:
  int size_;
  bool is_singular_ = false;
  std::vector<double> values_;
  std::vector<int> pivot_;  ///< row exchanged with row k
};

}  // namespace xfem
