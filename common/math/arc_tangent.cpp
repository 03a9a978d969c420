#include "common/math/arc_tangent.hpp"

#include <array>
#include <cmath>

namespace common {
namespace {

/// A number as the sum of two doubles.
struct Pair {
  double high;
  double low;
};

constexpr Pair kPi{3.141592653589793, 1.2246467991473532e-16};
constexpr Pair kHalfPi{1.5707963267948966, 6.123233995736766e-17};

/// atan(k / 8)
constexpr std::array<Pair, 9> kArcTangent{{
    {0.0, 0.0},
    {0.12435499454676144, -3.1253241424539383e-18},
    {0.24497866312686414, 1.0698755618734451e-17},
    {0.35877067027057225, -2.4623815582638635e-17},
    {0.4636476090008061, 2.2698777452961687e-17},
    {0.5585993153435624, -5.4556305485916264e-18},
    {0.6435011087932844, 1.5834785051444286e-17},
    {0.7188299996216245, -2.1478388444456983e-17},
    {0.7853981633974483, 3.061616997868383e-17},
}};

/// atan(small / large) for 0 <= small <= large, large > 0. |remainder| <= 1/16, so seven Taylor terms reach 2^-60.
double first_octant(double small, double large) {
  const int k = static_cast<int>(8 * (small / large) + 0.5);
  const double center = k / 8.0;
  const double remainder = (small - center * large) / (large + center * small);
  const double square = remainder * remainder;
  double series = 1.0 / 15;
  for (const int odd : {13, 11, 9, 7, 5, 3}) series = 1.0 / odd - square * series;
  const Pair base = kArcTangent[static_cast<std::size_t>(k)];
  return base.high + (remainder + (base.low - remainder * square * series));
}

}  // namespace

double arc_tangent2(double y, double x) {
  const double width = std::fabs(x);
  const double height = std::fabs(y);
  double angle = 0;
  if (width == 0 && height == 0) {
    angle = 0;
  } else if (height <= width) {
    angle = first_octant(height, width);
  } else {
    angle = kHalfPi.high - (first_octant(width, height) - kHalfPi.low);
  }
  if (std::signbit(x)) angle = kPi.high - (angle - kPi.low);
  return std::copysign(angle, y);
}

}  // namespace common
