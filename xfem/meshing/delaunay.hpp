// Delaunay triangulation of points that stand on the outline of a convex polygon and inside it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace xfem {

/// Triangles (counter-clockwise, lowest index first, sorted) of the Delaunay triangulation of `points`, of which the
/// first `boundary` stand on a convex outline in counter-clockwise order (points of one edge may be off its line by
/// rounding). Triangles outside the boundary polygon 0, 1, ..., boundary - 1 are dropped.
/// The result depends on the points alone: exact predicates, insertion in index order.
/// Throws numerical_failure if points coincide or the triangulation does not fill the boundary polygon.
std::vector<std::array<int, 3>> delaunay(std::span<const common::Vec2> points, int boundary);

}  // namespace xfem
