#include "common/geometry/chord_split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"

namespace common {
namespace {

/// How far off the boundary a chord end may be, in diameters.
constexpr double kReach = 1e-6;
/// A piece below this fraction of the parent's area is rounding.
constexpr double kNoArea = 1e-14;

/// A point of the boundary: a vertex, or inside the edge that starts at vertex `index`.
struct BoundaryPoint {
  std::size_t index;
  bool at_vertex;
  Vec2 point;
};

BoundaryPoint nearest_on_boundary(PolygonView polygon, const Vec2& point, double size, double snap) {
  const std::size_t n = polygon.size();
  BoundaryPoint nearest{0, false, polygon[0]};
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 edge = polygon[(i + 1) % n] - polygon[i];
    const double t = std::clamp((point - polygon[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const Vec2 foot = polygon[i] + t * edge;
    const double distance = (point - foot).norm();
    if (distance < smallest) {
      smallest = distance;
      nearest = {i, false, foot};
    }
  }
  if (!(smallest <= kReach * size)) {
    throw numerical_failure(
        fmt::format("chord split: the chord end ({}, {}) is {} m off the polygon's boundary, more than {} of its "
                    "diameter {} m",
                    point.x(), point.y(), smallest, kReach, size));
  }
  const std::size_t following = (nearest.index + 1) % n;
  const double to_start = (nearest.point - polygon[nearest.index]).norm();
  const double to_end = (nearest.point - polygon[following]).norm();
  if (std::min(to_start, to_end) <= snap * size) {
    const std::size_t vertex = to_start <= to_end ? nearest.index : following;
    return {vertex, true, polygon[vertex]};
  }
  return nearest;
}

/// True if one edge of the polygon (ends included) holds both points.
bool share_edge(const BoundaryPoint& p, const BoundaryPoint& q, std::size_t n) {
  const auto on_edge = [n](const BoundaryPoint& r, std::size_t edge) {
    return r.index == edge || (r.at_vertex && r.index == (edge + 1) % n);
  };
  for (std::size_t edge = 0; edge < n; ++edge) {
    if (on_edge(p, edge) && on_edge(q, edge)) return true;
  }
  return false;
}

/// The piece bounded by the boundary from `from` counter-clockwise to `to`, and the chord back.
Polygon piece(PolygonView polygon, const BoundaryPoint& from, const BoundaryPoint& to) {
  const std::size_t n = polygon.size();
  const std::size_t end = to.at_vertex ? to.index : (to.index + 1) % n;
  Polygon result{from.point};
  for (std::size_t i = (from.index + 1) % n; i != end; i = (i + 1) % n) result.push_back(polygon[i]);
  result.push_back(to.point);
  return result;
}

}  // namespace

ChordSplit split_by_chord(PolygonView polygon, const Vec2& first, const Vec2& last, double snap) {
  const double size = diameter(polygon);
  const BoundaryPoint start = nearest_on_boundary(polygon, first, size, snap);
  const BoundaryPoint stop = nearest_on_boundary(polygon, last, size, snap);
  if (share_edge(start, stop, polygon.size())) {
    throw numerical_failure(
        fmt::format("chord split: both chord ends, ({}, {}) and ({}, {}), lie on one edge of the polygon; two edges "
                    "are needed",
                    first.x(), first.y(), last.x(), last.y()));
  }
  ChordSplit split{piece(polygon, stop, start), piece(polygon, start, stop)};
  const double left = area(split.left);
  const double right = area(split.right);
  if (!(std::min(left, right) > kNoArea * area(polygon))) {
    throw numerical_failure(
        fmt::format("chord split: the chord from ({}, {}) to ({}, {}) cuts the polygon into {} and {} m^2; both "
                    "pieces must have an area",
                    first.x(), first.y(), last.x(), last.y(), left, right));
  }
  for (const Polygon* part : {&split.left, &split.right}) {
    if (const std::string defect = outline_defect(*part); !defect.empty()) {
      throw numerical_failure(
          fmt::format("chord split: the chord from ({}, {}) to ({}, {}) leaves a piece that is none: {}", first.x(),
                      first.y(), last.x(), last.y(), defect));
    }
  }
  return split;
}

}  // namespace common
