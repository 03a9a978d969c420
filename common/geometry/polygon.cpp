#include "common/geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace common {
namespace {

// Outlines of fragments carry rounding errors: depths below this fraction of the diameter do not count as defects.
constexpr double kTolerance = 1e-12;
// The direction of a short edge is known only as well as its end points are: to this fraction of the diameter.
constexpr double kRounding = 1e-15;

/// The moments of a fan of triangles about the first vertex, in coordinates relative to that vertex.
struct Moments {
  double twice_area = 0;
  Vec2 first = Vec2::Zero();  ///< 6 times the integral of (x, y)
  double polar = 0;           ///< 12 times the integral of x^2 + y^2
};

Moments moments(PolygonView polygon) {
  Moments sum;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec2 p = polygon[i] - polygon[0];
    const Vec2 q = polygon[i + 1] - polygon[0];
    const double weight = cross(p, q);
    sum.twice_area += weight;
    sum.first += weight * (p + q);
    sum.polar += weight * (p.squaredNorm() + p.dot(q) + q.squaredNorm());
  }
  return sum;
}

std::string at_vertex(std::size_t i, const Vec2& p) {
  return fmt::format("vertex {} ({}, {})", i, p.x(), p.y());
}

}  // namespace

double area(PolygonView polygon) {
  return 0.5 * moments(polygon).twice_area;
}

Vec2 centroid(PolygonView polygon) {
  const Moments sum = moments(polygon);
  return polygon[0] + sum.first / (3 * sum.twice_area);
}

double polar_moment(PolygonView polygon) {
  const Moments sum = moments(polygon);
  const Vec2 center = sum.first / (3 * sum.twice_area);
  return sum.polar / 12 - 0.5 * sum.twice_area * center.squaredNorm();
}

double diameter(PolygonView polygon) {
  double largest = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) largest = std::max(largest, (polygon[i] - polygon[j]).squaredNorm());
  }
  return std::sqrt(largest);
}

double radius_about(PolygonView polygon, const Vec2& center) {
  double largest = 0;
  for (const Vec2& p : polygon) largest = std::max(largest, (p - center).squaredNorm());
  return std::sqrt(largest);
}

std::string outline_defect(PolygonView polygon) {
  const std::size_t n = polygon.size();
  if (n < 3) return fmt::format("the outline has {} vertices; at least 3 are needed", n);
  for (std::size_t i = 0; i < n; ++i) {
    if (!polygon[i].allFinite()) return at_vertex(i, polygon[i]) + " is not finite";
  }
  const double size = diameter(polygon);
  for (std::size_t i = 0; i < n; ++i) {
    if ((polygon[(i + 1) % n] - polygon[i]).norm() <= kTolerance * size) {
      return fmt::format("{} is repeated by vertex {}", at_vertex(i, polygon[i]), (i + 1) % n);
    }
  }
  const double signed_area = area(polygon);
  if (std::abs(signed_area) <= kTolerance * size * size) {
    return fmt::format("the outline has no area ({} m^2 at a diameter of {} m)", signed_area, size);
  }
  if (signed_area < 0)
    return fmt::format("the outline is clockwise at {}; counter-clockwise is needed", at_vertex(0, polygon[0]));
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2& before = polygon[(i + n - 1) % n];
    const Vec2 base = polygon[(i + 1) % n] - before;
    if (cross(polygon[i] - before, base) < -kTolerance * size * base.norm()) {
      return fmt::format("the outline is not convex at {}", at_vertex(i, polygon[i]));
    }
  }
  // Every corner turns left; the outline must also go around only once.
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 edge = polygon[(i + 1) % n] - polygon[i];
    const double allowed = kTolerance * size * edge.norm() + kRounding * size * size;
    for (std::size_t k = 0; k < n; ++k) {
      if (cross(edge, polygon[k] - polygon[i]) < -allowed) {
        return fmt::format("the outline is not convex: {} is outside the edge that starts at vertex {}",
                           at_vertex(k, polygon[k]), i);
      }
    }
  }
  return {};
}

bool contains(PolygonView polygon, const Vec2& point) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& next = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    if (cross(next - polygon[i], point - polygon[i]) < 0) return false;
  }
  return true;
}

double equivalent_diameter(double area) {
  return std::sqrt(4 * area / std::numbers::pi);
}

}  // namespace common
