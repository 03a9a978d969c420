// Convex polygons for the geometry tests.
#pragma once

#include "common/geometry/polygon.hpp"
#include "common/math/random.hpp"

namespace common::test {

inline constexpr double kPi = 3.14159265358979323846;

inline Polygon box(double x, double y, double width, double height) {
  return {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
}

inline Polygon moved(Polygon polygon, double angle, const Vec2& shift) {
  const Rotation rotation(angle);
  for (Vec2& p : polygon) p = rotation * p + shift;
  return polygon;
}

/// 3 to 8 vertices on an ellipse about the origin with half axes `radius` and `radius / aspect`, turned at random.
inline Polygon random_polygon(Random& random, double radius, double aspect = 1) {
  const int n = 3 + static_cast<int>(random.index(6));
  Polygon polygon;
  for (int i = 0; i < n; ++i) {
    const SinCos at = sin_cos(2 * kPi * (i + random.uniform(-0.35, 0.35)) / n);
    polygon.push_back({radius * at.cos, radius / aspect * at.sin});
  }
  return moved(polygon, random.uniform(0, 2 * kPi), Vec2::Zero());
}

/// 10 to the power of a uniform number; only for test inputs.
inline double log_uniform(Random& random, int low, int high) {
  double value = random.uniform(1, 10);
  const int exponent = low + static_cast<int>(random.index(static_cast<std::uint64_t>(high - low)));
  for (int i = 0; i < exponent; ++i) value *= 10;
  for (int i = 0; i > exponent; --i) value /= 10;
  return value;
}

}  // namespace common::test
