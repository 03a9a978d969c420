// Cutting a convex polygon in two along the straight line through two points.
#pragma once

#include "common/geometry/polygon.hpp"

namespace common {

struct ChordSplit {
  Polygon left;   ///< left of the directed chord, counter-clockwise, in the parent's frame
  Polygon right;  ///< right of it
};

/// Splits a convex counter-clockwise polygon along the line from `first` to `last`, both on (or near, within
/// 1e-6 of its diameter) its boundary; they are moved onto the nearest edge. A chord end within `snap` * diameter of
/// a vertex is moved to that vertex, so that no sliver edge is made. The two chord vertices are bitwise the same in
/// both pieces, and the areas sum to the parent's within 1e-12 relative + 1e-15 diameter^2 (rounding of a sliver's new
/// vertices). Both pieces are convex.
/// Throws numerical_failure if both ends lie on one edge, or a piece would have no area or not be an outline.
ChordSplit split_by_chord(PolygonView polygon, const Vec2& first, const Vec2& last, double snap = 1e-9);

}  // namespace common
