// Numbers of twice the precision of a double: an unevaluated sum high + low, |low| <= ulp(high) / 2.
// T. J. Dekker, A floating-point technique for extending the available precision, Numer. Math. 18, 1971;
// M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds for basic building blocks of double-word
// arithmetic, ACM TOMS 44(2), 2017: relative errors of a sum of equal signs, a product and a quotient are below 2^-101.
#pragma once

#include <cmath>

namespace differential {

struct DoubleDouble {
  double high = 0;
  double low = 0;
};

/// a + b exactly (Knuth).
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a - b exactly.
inline DoubleDouble two_difference(double a, double b) {
  return two_sum(a, -b);
}

/// a * b exactly, if nothing underflows.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// a + b exactly for |a| >= |b|.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble high = two_sum(a.high, b.high);
  const DoubleDouble low = two_sum(a.low, b.low);
  const DoubleDouble sum = quick_two_sum(high.high, high.low + low.high);
  return quick_two_sum(sum.high, sum.low + low.low);
}

inline DoubleDouble operator-(const DoubleDouble& a) {
  return {-a.high, -a.low};
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + -b;
}

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return quick_two_sum(product.high, product.low + std::fma(a.high, b.low, a.low * b.high));
}

inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - DoubleDouble{first, 0} * b;
  const double second = rest.high / b.high;
  const DoubleDouble last = rest - DoubleDouble{second, 0} * b;
  return quick_two_sum(first, second) + DoubleDouble{last.high / b.high, 0};
}

inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
  return a.high != b.high ? a.high < b.high : a.low < b.low;
}

inline double to_double(const DoubleDouble& a) {
  return a.high + a.low;
}

}  // namespace differential
