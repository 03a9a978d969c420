#include "common/geometry/center.hpp"

namespace common {
namespace {

constexpr double kNear = 1000;  // diameters

}  // namespace

Center center_of(PolygonView polygon) {
  Center center{centroid(polygon), Vec2::Zero()};
  if (center.coarse.norm() <= kNear * diameter(polygon)) return center;
  Polygon moved;
  for (const Vec2& p : polygon) moved.push_back(p - center.coarse);
  center.fine = centroid(moved);
  return center;
}

}  // namespace common
