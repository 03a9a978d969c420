// The overlap of two convex polygons by clipping: slower than `overlap`, right in every position.
#pragma once

#include "common/geometry/overlap.hpp"

namespace common {

/// As `overlap` (same arguments, accuracy and limits), without a cache. `overlap` calls it where its short cut, two
/// plain crossings, does not hold; results agree to rounding.
Overlap clip_overlap(const OutlineView& a, const OutlineView& b, OverlapOutline* outline = nullptr);

}  // namespace common
