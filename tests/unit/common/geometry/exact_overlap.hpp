// The overlap of two convex polygons in exact arithmetic: the oracle of the overlap tests.
#pragma once

#include "common/geometry/polygon.hpp"

namespace common::test {

struct ExactOverlap {
  double area;  ///< rounded once, from the exact rational
  Vec2 chord;   ///< sum of the pieces of a's boundary inside b, rounded once
};

/// The nearest number that exact_overlap takes: a multiple of 2^-60. Doubles above 2^-8 are such numbers already.
double on_grid(double x);
Polygon on_grid(Polygon polygon);

/// By another way than the kernel's: every edge of either polygon is clipped against the other polygon as a parameter
/// interval [s, t] (Cyrus and Beck), and by Green's theorem twice the area is the sum of (t - s) cross(start, edge).
/// Coordinates are multiples of 2^-60 below 1 in magnitude, so that signs are exact in 128-bit integers.
ExactOverlap exact_overlap(PolygonView a, PolygonView b);

}  // namespace common::test
