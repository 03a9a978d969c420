#include "tests/unit/common/geometry/exact_overlap.hpp"

#include <CGAL/Gmpq.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace common::test {
namespace {

constexpr int kBits = 60;
__extension__ using Wide = __int128;

struct Point {
  std::int64_t x;
  std::int64_t y;
};

Point operator-(const Point& p, const Point& q) {
  return {p.x - q.x, p.y - q.y};
}
Wide cross(const Point& p, const Point& q) {
  return Wide{p.x} * q.y - Wide{p.y} * q.x;
}
Wide dot(const Point& p, const Point& q) {
  return Wide{p.x} * q.x + Wide{p.y} * q.y;
}

CGAL::Gmpz integer(Wide value) {
  const bool negative = value < 0;
  CGAL::Gmpz result = 0;
  const Wide magnitude = negative ? -value : value;
  for (int shift = 120; shift >= 0; shift -= 24) {
    result = result * CGAL::Gmpz(1 << 24) + CGAL::Gmpz(static_cast<int>((magnitude >> shift) & 0xffffff));
  }
  return negative ? -result : result;
}

CGAL::Gmpq ratio(Wide numerator, Wide denominator) {
  return {integer(numerator), integer(denominator)};
}

std::vector<Point> integers(PolygonView polygon) {
  std::vector<Point> result;
  for (const Vec2& p : polygon) {
    const double x = std::ldexp(p.x(), kBits);
    const double y = std::ldexp(p.y(), kBits);
    if (std::abs(p.x()) >= 1 || std::abs(p.y()) >= 1 || x != std::floor(x) || y != std::floor(y)) {
      throw std::invalid_argument("exact_overlap: the coordinates are not multiples of 2^-60 below 1");
    }
    result.push_back({static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)});
  }
  return result;
}

struct Sums {
  CGAL::Gmpq twice_area = 0;
  CGAL::Gmpq x = 0;
  CGAL::Gmpq y = 0;
};

/// Adds the pieces of `subject`'s boundary inside `window`. Where two edges run along each other in one direction
/// both are the boundary of the overlap; `shared_counts` says whether this one is to be counted.
Sums boundary_inside(const std::vector<Point>& subject, const std::vector<Point>& window, bool shared_counts) {
  Sums sums;
  for (std::size_t i = 0; i < subject.size(); ++i) {
    const Point p = subject[i];
    const Point q = subject[(i + 1) % subject.size()];
    CGAL::Gmpq from = 0;
    CGAL::Gmpq to = 1;
    bool inside = true;
    for (std::size_t j = 0; j < window.size() && inside; ++j) {
      const Point v = window[j];
      const Point edge = window[(j + 1) % window.size()] - v;
      const Wide height_p = cross(edge, p - v);
      const Wide height_q = cross(edge, q - v);
      if (height_p == 0 && height_q == 0) {
        inside = shared_counts || dot(edge, q - p) < 0;
      } else if (height_p <= 0 && height_q <= 0) {
        inside = false;
      } else if (height_p < 0) {
        from = std::max(from, ratio(height_p, height_p - height_q));
      } else if (height_q < 0) {
        to = std::min(to, ratio(height_p, height_p - height_q));
      }
    }
    if (!inside || from >= to) continue;
    const CGAL::Gmpq share = to - from;
    sums.twice_area += share * CGAL::Gmpq(integer(cross(p, q)));
    sums.x += share * CGAL::Gmpq(integer(q.x - p.x));
    sums.y += share * CGAL::Gmpq(integer(q.y - p.y));
  }
  return sums;
}

}  // namespace

double on_grid(double x) {
  return std::ldexp(std::nearbyint(std::ldexp(x, kBits)), -kBits);
}

Polygon on_grid(Polygon polygon) {
  for (Vec2& p : polygon) p = {on_grid(p.x()), on_grid(p.y())};
  return polygon;
}

ExactOverlap exact_overlap(PolygonView a, PolygonView b) {
  const std::vector<Point> first = integers(a);
  const std::vector<Point> second = integers(b);
  const Sums of_a = boundary_inside(first, second, true);
  const Sums of_b = boundary_inside(second, first, false);
  const double twice_area = CGAL::to_double(of_a.twice_area + of_b.twice_area);
  return {std::ldexp(twice_area, -2 * kBits - 1),
          {std::ldexp(CGAL::to_double(of_a.x), -kBits), std::ldexp(CGAL::to_double(of_a.y), -kBits)}};
}

}  // namespace common::test
