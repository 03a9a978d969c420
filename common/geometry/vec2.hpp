// Plane vectors and rotations.
#pragma once

#include <Eigen/Core>

#include "common/math/trigonometry.hpp"

namespace common {

using Vec2 = Eigen::Vector2d;

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
/// `a` turned by +90 degrees.
inline Vec2 perpendicular(const Vec2& a) {
  return {-a.y(), a.x()};
}

/// A rotation by a fixed angle.
struct Rotation {
  double cos = 1;
  double sin = 0;

  Rotation() = default;
  explicit Rotation(double angle) {
    const SinCos values = sin_cos(angle);
    cos = values.cos;
    sin = values.sin;
  }
  /// Body frame to world frame.
  Vec2 operator*(const Vec2& v) const { return {cos * v.x() - sin * v.y(), sin * v.x() + cos * v.y()}; }
  /// World frame to body frame.
  Vec2 inverse(const Vec2& v) const { return {cos * v.x() + sin * v.y(), cos * v.y() - sin * v.x()}; }
};

}  // namespace common
