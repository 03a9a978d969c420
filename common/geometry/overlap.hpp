// Overlap of two convex polygons: what a contact law needs to know of a contact.
#pragma once

#include <cstdint>

#include "common/geometry/outline_view.hpp"
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

/// What the last query learned of a pair: an edge that has the other polygon outside, or else which edges cross and
/// which vertices lie between. Zero: nothing known. Any value is allowed, also of another pair: it decides how fast the
/// answer comes; the answer differs by rounding at most (of the vertices: the chord of a polygon that touches another
/// from inside is one of those that a shift by rounding gives).
struct PairFeature {
  std::uint8_t edge = 0;   ///< separates, or is where the other boundary enters: from vertex `edge` to the next one; an
                           ///< edge of a, or of b if kOfB is added
  std::uint8_t exit = 0;   ///< 0: `edge` separates; else 1 + the edge, of the same polygon, where the other one leaves
  std::uint8_t first = 0;  ///< first and last vertex of the other polygon inside
  std::uint8_t last = 0;

  static constexpr unsigned kOfB = 128;
};

inline constexpr int kMaxOverlapVertices = 128;
/// Most vertices of one particle.
inline constexpr int kMaxParticleVertices = kMaxOverlapVertices / 2;

/// The overlap polygon where there are two crossings and both bodies have corners inside the other one,
/// counter-clockwise, from the crossing at which b's boundary begins. Edges 0..first_a-1 are pieces of b's boundary,
/// the others of a's; vertices 0 and first_a are the crossings.
struct OverlapOutline {
  int size;  ///< 0: one of the boundaries is straight, or not two crossings; nothing below is set
  int first_a;
  Vec2 origin;                    ///< vertex 0 [m]
  double x[kMaxOverlapVertices];  ///< relative to the origin [m]
  double y[kMaxOverlapVertices];

  OverlapOutline() {}  // leaves its 2 KB as they are
};

/// Of `overlap`: sets `result`, until then Overlap(), if the polygons overlap, and `outline`, until then of size 0.
void find_overlap(const OutlineView& a, const OutlineView& b, PairFeature& feature, Overlap& result,
                  OverlapOutline* outline);

/// Overlap of two convex counter-clockwise polygons, at most kMaxOverlapVertices vertices together.
/// Never allocates, never fails: touching or separated polygons give area 0.
/// |area - exact| <= 1e-10 exact + 1e-15 D^2, D the larger diameter, in coordinates relative to one of the two; 7e-16
/// D^3 / L more where a corner beside an edge of length L is straight to rounding. Writes `outline` unless it is null.
inline Overlap overlap(const OutlineView& a, const OutlineView& b, PairFeature& feature, OverlapOutline* outline) {
  Overlap result;
  if (outline) outline->size = 0;
  find_overlap(a, b, feature, result, outline);
  return result;
}
inline Overlap overlap(const OutlineView& a, const OutlineView& b, PairFeature& feature) {
  return overlap(a, b, feature, nullptr);
}

/// The same of a single pair, nothing being known of it.
Overlap overlap(PolygonView a, PolygonView b, OverlapOutline* outline = nullptr);

}  // namespace common
