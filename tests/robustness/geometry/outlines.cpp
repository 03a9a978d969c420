#include "tests/robustness/geometry/outlines.hpp"

#include <algorithm>
#include <cmath>

#include "tests/robustness/geometry/double_double.hpp"

namespace differential {
namespace {

/// The six products of the expanded determinant, each a sum of two doubles, added up without rounding (grow_expansion
/// of Shewchuk, cited below): the components do not overlap, so that the largest one has the sign of the sum.
int exact_orientation(double px, double py, double qx, double qy, double rx, double ry) {
  std::array<double, 12> sum{};
  int size = 0;
  const auto add = [&](double term) {
    for (int k = 0; k < size; ++k) {
      const DoubleDouble both = two_sum(term, sum[k]);
      sum[k] = both.low;
      term = both.high;
    }
    sum[size++] = term;
  };
  const double factors[6][2] = {{qx, ry}, {-qx, py}, {-px, ry}, {-qy, rx}, {qy, px}, {py, rx}};
  for (const auto& [u, v] : factors) {
    const DoubleDouble product = two_product(u, v);
    add(product.low);
    add(product.high);
  }
  for (int k = size - 1; k >= 0; --k) {
    if (sum[k] != 0) return sum[k] > 0 ? 1 : -1;
  }
  return 0;
}

}  // namespace

void Outline::pad() {
  for (int i = size; i < common::padded_size(size); ++i) {
    x[i] = x[size - 1];
    y[i] = y[size - 1];
  }
}

double diameter(const Outline& outline) {
  double largest = 0;
  for (int i = 0; i < outline.size; ++i) {
    for (int j = 0; j < i; ++j) {
      const double dx = outline.x[i] - outline.x[j];
      const double dy = outline.y[i] - outline.y[j];
      largest = std::max(largest, dx * dx + dy * dy);
    }
  }
  return std::sqrt(largest);
}

int orientation(double px, double py, double qx, double qy, double rx, double ry) {
  const double first = (qx - px) * (ry - py);
  const double second = (qy - py) * (rx - px);
  const double difference = first - second;
  // J. R. Shewchuk, Adaptive precision floating-point arithmetic, Discrete Comput. Geom. 18, 1997: (3 + 16 e) e.
  const double doubt = 3.3306690738754716e-16 * (std::abs(first) + std::abs(second));
  if (difference > doubt) return 1;
  if (difference < -doubt) return -1;
  return exact_orientation(px, py, qx, qy, rx, ry);
}

int make_convex(Outline& outline) {
  const int before = outline.size;
  bool changed = true;
  while (changed && outline.size > 2) {
    changed = false;
    for (int i = 0; i < outline.size && outline.size > 2; ++i) {
      const int last = outline.previous(i);
      const int next = outline.next(i);
      if (orientation(outline.x[last], outline.y[last], outline.x[i], outline.y[i], outline.x[next], outline.y[next]) >
          0) {
        continue;
      }
      std::copy(outline.x.begin() + i + 1, outline.x.begin() + outline.size, outline.x.begin() + i);
      std::copy(outline.y.begin() + i + 1, outline.y.begin() + outline.size, outline.y.begin() + i);
      --outline.size;
      --i;
      changed = true;
    }
  }
  return before - outline.size;
}

}  // namespace differential
