// The centroid of an outline that may be anywhere, say in coordinates of a survey.
#pragma once

#include "common/geometry/polygon.hpp"

namespace common {

/// Centroid as a sum of two vectors [m]. One alone is rounded to the last digits of the place: 1e-9 m at 10^7 m, which
/// leaves an outline that is moved there off its centroid, and its fragments with another momentum than it had.
struct Center {
  Vec2 coarse;
  Vec2 fine;  ///< zero if the origin is near

  Vec2 to(const Vec2& p) const { return (p - coarse) - fine; }
};

/// `to(vertex)` has the centroid within 1.6e-13 D of the origin, D the diameter, besides what centroid() is uncertain
/// by: from 1000 D on `fine` is the centroid of what `coarse`, rounded to 2^-53 of the distance, leaves.
Center center_of(PolygonView polygon);

}  // namespace common
