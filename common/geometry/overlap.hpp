// Overlap of two convex polygons: what a contact law needs to know of a contact.
#pragma once

#include "common/geometry/polygon.hpp"

namespace common {

/// Geometry of the overlap of convex polygons a and b.
///
/// With two boundary crossings the chord joins them: `width` is its length, `normal` is perpendicular to it and
/// `chord_midpoint` its middle. In general (four or more crossings) the chord vector is the sum of the pieces of a's
/// boundary inside b; it is the gradient of the overlap area, dA/d(position of b) = -width * normal.
/// Full inclusion has no crossing: the normal is the centre line from a to b ((1, 0) if the centres coincide),
/// width = sqrt(area). The same holds where the chord vanishes (below 1e-12 sqrt(area)): identical polygons, inclusion
/// with a vertex on the boundary, bars that cross symmetrically (these keep their 4 crossings). Everywhere area / width
/// <= sqrt(area): a smaller width is raised to sqrt(area).
struct Overlap {
  double area = 0;                     ///< [m^2]; 0: no overlap, and nothing below is set
  double width = 0;                    ///< b of the contact laws [m]
  Vec2 normal = Vec2::Zero();          ///< unit vector, from a to b
  Vec2 centroid = Vec2::Zero();        ///< of the overlap polygon [m]
  Vec2 chord_midpoint = Vec2::Zero();  ///< middle of the crossings [m]; the centroid for inclusion
  int crossings = 0;                   ///< boundary crossings: 2, 4, ...; 0 for inclusion
};

/// Overlap of two convex counter-clockwise polygons, at most kMaxOverlapVertices vertices together.
/// Never allocates, never fails: touching or separated polygons give area 0.
/// |area - exact| <= 1e-10 exact + 1e-15 D^2, D the larger diameter, if the coordinates are relative to one of the
/// two particles.
Overlap overlap(PolygonView a, PolygonView b);

inline constexpr int kMaxOverlapVertices = 128;
/// Most vertices of one particle.
inline constexpr int kMaxParticleVertices = kMaxOverlapVertices / 2;

}  // namespace common
