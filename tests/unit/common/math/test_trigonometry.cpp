#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/math/random.hpp"
#include "common/math/trigonometry.hpp"

using namespace common;

namespace {

constexpr double kUnit = 0x1p-52;  // a unit in the last place of 1

/// Largest error of both functions, in units in the last place of 1, against the C library's long double.
double error(double angle) {
  const SinCos found = sin_cos(angle);
  const long double sine = std::sin(static_cast<long double>(angle));
  const long double cosine = std::cos(static_cast<long double>(angle));
  return static_cast<double>(std::max(std::abs(found.sin - sine), std::abs(found.cos - cosine))) / kUnit;
}

}  // namespace

TEST_CASE("sine and cosine agree with the long double library within 2 units up to a million radians") {
  Random random(51);
  double worst = 0;
  for (const double range : {1e-8, 1e-3, 0.8, 3.2, 10.0, 1e3, 1e5, 1e6}) {
    for (int i = 0; i < 50000; ++i) worst = std::max(worst, error(random.uniform(-range, range)));
  }
  // Around every multiple of pi/4, where the quadrant changes or a function is zero.
  for (int k = -100000; k <= 100000; ++k) {
    const double angle = k * 0.78539816339744831;
    for (const double x : {angle, std::nextafter(angle, 1e9), std::nextafter(angle, -1e9)}) {
      worst = std::max(worst, error(x));
    }
  }
  worst = std::max({worst, error(1e6), error(-1e6)});
  CHECK(worst < 2);
}

TEST_CASE("sine is odd, cosine is even, and their squares sum to 1") {
  Random random(52);
  for (int i = 0; i < 10000; ++i) {
    const double angle = random.uniform(-100, 100);
    const SinCos plus = sin_cos(angle);
    const SinCos minus = sin_cos(-angle);
    REQUIRE(plus.sin == -minus.sin);
    REQUIRE(plus.cos == minus.cos);
    REQUIRE(std::abs(plus.sin * plus.sin + plus.cos * plus.cos - 1) < 4 * kUnit);
  }
  CHECK(sin_cos(0).sin == 0);
  CHECK(sin_cos(0).cos == 1);
}

TEST_CASE("angles out of range and angles that are not numbers give NaN") {
  for (const double angle : {1.0000001e6, -1e300, std::numeric_limits<double>::infinity(), std::nan("")}) {
    CHECK(std::isnan(sin_cos(angle).sin));
    CHECK(std::isnan(sin_cos(angle).cos));
  }
}

TEST_CASE("sine and cosine have fixed bits") {
  // A hash over many values; it changes with any change of the polynomials, the reduction or the compiler's rounding.
  Random random(53);
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const SinCos found = sin_cos(random.uniform(-1000, 1000));
    sum = 0.5 * sum + found.sin - 0.25 * found.cos;
  }
  CHECK(sum == -0x1.0ef11b80956cap-2);
}
