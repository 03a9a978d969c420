// Moving interior nodes so that the smallest angles grow.
#pragma once

#include <array>
#include <vector>

#include "xfem/meshing/placement.hpp"

namespace xfem {

/// Cosine of the smallest angle of a triangle (a, b, c counter-clockwise): 0.5 for the equilateral one, 1 for a needle,
/// 2 if inverted or flat.
double smallest_angle_cosine(const common::Vec2& a, const common::Vec2& b, const common::Vec2& c);

/// Moves the points from `boundary` on (interior ones) and re-triangulates in turn; returns the triangles of the final
/// points.
std::vector<std::array<int, 3>> smooth(std::vector<common::Vec2>& points, int boundary, const SizeField& size,
                                       int passes);

}  // namespace xfem
