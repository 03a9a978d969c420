// A crack that a specimen has from the start, placed on a mesh so that its mechanical length is the declared one.
#pragma once

#include "xfem/crack/path.hpp"

namespace xfem {

/// A crack acts as if it ended this many element sizes before the last point of its polyline, because the nodes of the
/// tip edge are not enriched and the opening closes linearly there. Measured on stress intensities of central, edge and
/// inclined cracks (xfem/README.md, Toughness): a constant of the element type.
inline constexpr double kTipShift = 0.4;

/// The straight crack between two points. An end on the boundary or outside it is a mouth. Points of a polyline stand
/// on mesh edges, so the line is moved sideways at each end, by at most 0.3 element sizes, to where edges are crossed
/// at the right length. Throws bad_input if no end is inside, or if fewer than three elements lie between the ends:
/// such a crack has no effect.
Crack place_given_crack(const Mesh& mesh, PolygonView outline, const Vec2& from, const Vec2& to);

}  // namespace xfem
