#include "xfem/canonical.hpp"

#include <cmath>
#include <string>

#include "common/error.hpp"

namespace xfem {

CanonicalOutline canonical(PolygonView outline) {
  if (const std::string defect = common::outline_defect(outline); !defect.empty()) {
    throw common::numerical_failure("mesh: " + defect);
  }
  constexpr double kGrid = 1099511627776.0;  // 2^40
  CanonicalOutline result;
  result.center = common::centroid(outline);
  result.size = common::equivalent_diameter(common::area(outline));
  result.outline.reserve(outline.size());
  for (const Vec2& vertex : outline) {
    const Vec2 p = result.to_canonical(vertex) * kGrid;
    result.outline.emplace_back(std::floor(p.x() + 0.5) / kGrid, std::floor(p.y() + 0.5) / kGrid);
  }
  return result;
}

}  // namespace xfem
