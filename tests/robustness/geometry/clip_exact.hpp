// The second oracle: overlap of two convex polygons in rational numbers, for any doubles.
#pragma once

#include "tests/robustness/geometry/outlines.hpp"

namespace differential {

/// Area of the overlap, rounded once from the exact rational [m^2]. By a third way, which shares nothing with either
/// clip: the overlap is the convex hull of the vertices of each polygon inside the other and of the crossings of their
/// edges; its area is that of the hull (A. M. Andrew's monotone chain, Inform. Process. Lett. 9, 1979).
double exact_area(const OutlinePair& pair);

}  // namespace differential
