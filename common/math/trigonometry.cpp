#include "common/math/trigonometry.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace common {
namespace {

constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
// pi/2 = kHigh + kMiddle + kLow; the first two have 33 significant bits, so that their products with the quadrant
// number (below 2^20) are exact. The split is that of W. J. Cody and W. Waite, Software Manual for the Elementary
// Functions (1980), chapter 8.
constexpr double kHigh = 0x1.921fb544p+0;
constexpr double kMiddle = 0x1.0b4611a6p-34;
constexpr double kLow = 0x1.3198a2e037073p-69;
constexpr double kLargestAngle = 1e6;

/// sin(x) for |x| <= pi/4; the first neglected term x^19/19! is below 1e-19.
double sine(double x) {
  const double s = x * x;
  double tail = 1.0 / 355687428096000.0;
  tail = tail * s - 1.0 / 1307674368000.0;
  tail = tail * s + 1.0 / 6227020800.0;
  tail = tail * s - 1.0 / 39916800.0;
  tail = tail * s + 1.0 / 362880.0;
  tail = tail * s - 1.0 / 5040.0;
  tail = tail * s + 1.0 / 120.0;
  tail = tail * s - 1.0 / 6.0;
  return x + x * (s * tail);
}

/// cos(x) for |x| <= pi/4; the first neglected term x^18/18! is below 3e-18.
double cosine(double x) {
  const double s = x * x;
  double tail = 1.0 / 20922789888000.0;
  tail = tail * s - 1.0 / 87178291200.0;
  tail = tail * s + 1.0 / 479001600.0;
  tail = tail * s - 1.0 / 3628800.0;
  tail = tail * s + 1.0 / 40320.0;
  tail = tail * s - 1.0 / 720.0;
  tail = tail * s + 1.0 / 24.0;
  return 1.0 - (0.5 * s - s * s * tail);
}

}  // namespace

SinCos sin_cos(double angle) {
  if (!(std::abs(angle) <= kLargestAngle)) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    return {kNan, kNan};
  }
  const double turns = std::floor(angle * kTwoOverPi + 0.5);
  const double x = ((angle - turns * kHigh) - turns * kMiddle) - turns * kLow;
  const double s = sine(x);
  const double c = cosine(x);
  switch (static_cast<std::int64_t>(turns) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace common
