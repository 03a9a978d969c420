// Random convex outlines for the tests of xfem.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/geometry/polygon.hpp"
#include "common/math/random.hpp"

namespace test_outlines {

using common::Polygon;
using common::Vec2;

/// 5 to 8 corners on an ellipse of semi-axes 1 and `aspect`, turned at random.
inline Polygon random_outline(common::Random& random, double aspect) {
  const int corners = 5 + static_cast<int>(random.index(4));
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  Polygon result;
  for (int i = 0; i < corners; ++i) {
    const double angle = (i + random.uniform(-0.25, 0.25)) * 2 * std::numbers::pi / corners;
    const double x = std::cos(angle), y = aspect * std::sin(angle);
    result.emplace_back(std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y);
  }
  return result;
}

/// The part of a convex polygon to the left of the line through `point` along `direction`.
inline Polygon left_part(const Polygon& polygon, const Vec2& point, const Vec2& direction) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    const double side_a = common::cross(direction, a - point);
    const double side_b = common::cross(direction, b - point);
    if (side_a >= 0) result.push_back(a);
    if (side_a * side_b < 0) result.push_back(a + (b - a) * (side_a / (side_a - side_b)));
  }
  return result;
}

inline Polygon regular(int corners, double radius, double turn = 0) {
  Polygon result;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 2 * std::numbers::pi * i / corners;
    result.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return result;
}

inline double smallest_corner_degrees(const Polygon& p) {
  double result = 180;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 a = p[(i + p.size() - 1) % p.size()] - p[i];
    const Vec2 b = p[(i + 1) % p.size()] - p[i];
    result = std::min(result, std::atan2(std::abs(common::cross(a, b)), a.dot(b)) * 180 / std::numbers::pi);
  }
  return result;
}

inline double shortest_edge(const Polygon& p) {
  double result = (p.front() - p.back()).norm();
  for (std::size_t i = 0; i + 1 < p.size(); ++i) result = std::min(result, (p[i + 1] - p[i]).norm());
  return result;
}

}  // namespace test_outlines
