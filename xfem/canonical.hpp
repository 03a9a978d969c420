// The outline of a particle without its size and place, so that particles of one shape share everything but those.
//
// K of a plane body is invariant under scaling, stress = force / (length x thickness) as well: a particle of
// equivalent diameter De under forces f has the stress of the particle of diameter 1 under f / De, and its cracks.
#pragma once

#include "common/geometry/polygon.hpp"

namespace xfem {

using common::Polygon;
using common::PolygonView;
using common::Vec2;

/// x = center + size * x', x' the canonical coordinates.
struct CanonicalOutline {
  Polygon outline;  ///< x', rounded to a grid of 2^-40: outlines that differ by size or place alone (and by rounding)
                    ///< have the same bits, but for one in hundreds, where a coordinate falls on a grid cell's edge
  Vec2 center = Vec2::Zero();  ///< centroid [m]
  double size = 1;             ///< De = sqrt(4 A / pi) [m]

  Vec2 to_canonical(const Vec2& x) const { return (x - center) / size; }
  Vec2 from_canonical(const Vec2& x) const { return center + size * x; }
};

/// Throws numerical_failure for an outline that is not a convex counter-clockwise polygon.
CanonicalOutline canonical(PolygonView outline);

}  // namespace xfem
