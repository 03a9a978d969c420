#include "xfem/elasticity/stiffness.hpp"

#include <algorithm>
#include <cmath>

namespace xfem {

std::vector<ElementGradients> element_gradients(const Mesh& mesh) {
  std::vector<ElementGradients> result(mesh.triangles.size());
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 edge = mesh.nodes[mesh.triangles[t][(k + 2) % 3]] - mesh.nodes[mesh.triangles[t][(k + 1) % 3]];
      result[t].gradient[k] = common::perpendicular(edge) / (2 * mesh.areas[t]);
    }
  }
  return result;
}

std::array<int, 3> determinate_supports(const Mesh& mesh) {
  const std::vector<int> loop = boundary_loop(mesh);
  Vec2 center = Vec2::Zero();
  for (const int node : loop) center += mesh.nodes[node] / static_cast<double>(loop.size());
  const auto farthest = [&](const Vec2& from) {
    // The margin makes equal distances fall on the first node whatever the rounding.
    int result = loop.front();
    double largest = 0;
    for (const int node : loop) {
      const double distance = (mesh.nodes[node] - from).squaredNorm();
      if (distance > largest * (1 + 1e-9)) {
        largest = distance;
        result = node;
      }
    }
    return result;
  };
  const int first = farthest(center);
  const int second = farthest(mesh.nodes[first]);
  const Vec2 line = mesh.nodes[second] - mesh.nodes[first];
  std::array<int, 3> result{2 * first, 2 * first + 1, 2 * second + (std::abs(line.x()) >= std::abs(line.y()) ? 1 : 0)};
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace xfem
