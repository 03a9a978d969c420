// Oracle: the C library's 80-bit atan2l.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/math/arc_tangent.hpp"
#include "common/math/random.hpp"

using common::arc_tangent2;

namespace {

double error_in_ulps(double y, double x) {
  const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
  const double rounded = std::fabs(static_cast<double>(exact));
  const double ulp = std::nextafter(rounded, std::numeric_limits<double>::infinity()) - rounded;
  return static_cast<double>(std::fabs(arc_tangent2(y, x) - exact) / ulp);
}

}  // namespace

TEST_CASE("the arc tangent is within 2 units in the last place in all quadrants and at all ratios") {
  common::Random random(3);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    double y = random.uniform(-1, 1);
    double x = random.uniform(-1, 1);
    if (i % 3 == 1) y *= std::ldexp(1.0, -static_cast<int>(random.index(100)));
    if (i % 3 == 2) x *= std::ldexp(1.0, -static_cast<int>(random.index(100)));
    worst = std::max(worst, error_in_ulps(y, x));
  }
  for (int k = -16; k <= 16; ++k) {
    for (const double x : {-1.0, 1.0})
      worst = std::max({worst, error_in_ulps(k / 16.0, x), error_in_ulps(x, k / 16.0)});
  }
  CAPTURE(worst);
  CHECK(worst <= 2);
}

TEST_CASE("the arc tangent keeps the signs of zeros and the axes") {
  const double pi = 3.14159265358979323846;
  CHECK(arc_tangent2(0.0, 0.0) == 0);
  CHECK(arc_tangent2(0.0, 2.0) == 0);
  CHECK(std::signbit(arc_tangent2(-0.0, 2.0)));
  CHECK(arc_tangent2(0.0, -2.0) == pi);
  CHECK(arc_tangent2(-0.0, -2.0) == -pi);
  CHECK(arc_tangent2(3.0, 0.0) == pi / 2);
  CHECK(arc_tangent2(-3.0, 0.0) == -pi / 2);
}
