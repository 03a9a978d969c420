// The first oracle: overlap of two convex polygons in double-double arithmetic, with a bound of its own error.
#pragma once

#include "tests/robustness/geometry/outlines.hpp"

namespace differential {

struct DoubleDoubleClip {
  double area = 0;                            ///< [m^2]
  double area_error = 0;                      ///< |area - exact| is no more [m^2]
  common::Vec2 chord = common::Vec2::Zero();  ///< sum of the pieces of a's boundary inside b [m]
  double chord_error = 0;                     ///< each component is within it of the exact one [m]
};

/// Every edge of either polygon is clipped against the other polygon as a parameter interval [s, t] (M. Cyrus and
/// J. Beck, Generalized two- and three-dimensional clipping, Computers & Graphics 3, 1978), and by Green's theorem
/// twice the area is the sum of (t - s) cross(start, end). Both outlines are strictly convex (make_convex).
/// Which edges are cut is decided by exact signs: a filter in doubles, one in double-double arithmetic, then
/// rational numbers; so that only where they are cut is rounded.
DoubleDoubleClip clip_double_double(const OutlinePair& pair);

}  // namespace differential
