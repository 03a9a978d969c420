#include "xfem/crack/edge_loads.hpp"

#include <algorithm>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "xfem/elasticity/stiffness.hpp"

namespace xfem {
namespace {

std::vector<Vec2> positions(const Mesh& mesh, std::span<const int> nodes) {
  std::vector<Vec2> points;
  for (const int node : nodes) points.push_back(mesh.nodes[node]);
  return points;
}

}  // namespace

BodyForce inertia_relief(const Mesh& mesh, std::span<const Load> loads, double patch) {
  double area = 0;
  Vec2 first = Vec2::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    area += mesh.areas[t];
    first += mesh.areas[t] * (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]) / 3;
  }
  const Vec2 center = first / area;
  double polar = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    // Three mid-edge points integrate a quadratic exactly.
    for (const Vec2& middle : {Vec2((mesh.nodes[a] + mesh.nodes[b]) / 2), Vec2((mesh.nodes[b] + mesh.nodes[c]) / 2),
                               Vec2((mesh.nodes[c] + mesh.nodes[a]) / 2)}) {
      polar += mesh.areas[t] / 3 * (middle - center).squaredNorm();
    }
  }
  const std::vector<Vec2> loop = positions(mesh, boundary_loop(mesh));
  return {center, rigid_acceleration(loop, boundary_forces(loop, loads, patch), area, center, polar)};
}

Vec2 integrate_body_force(PolygonView part, double area, const Vec2& gradient, const Vec2& element_center,
                          const BodyForce& body) {
  const auto value = [&](const Vec2& x) -> Vec2 {
    const double shape = 1.0 / 3 + gradient.dot(x - element_center);
    return -shape * (body.acceleration.linear + body.acceleration.angular * common::perpendicular(x - body.center));
  };
  Vec2 sum = Vec2::Zero();
  double covered = 0;
  for (std::size_t i = 1; i + 1 < part.size(); ++i) {
    const Vec2 &a = part[0], &b = part[i], &c = part[i + 1];
    const double weight = common::cross(b - a, c - a) / 2;
    covered += weight;
    sum += weight / 3 * (value((a + b) / 2) + value((b + c) / 2) + value((c + a) / 2));
  }
  return covered != 0 ? Vec2(sum * (area / covered)) : Vec2::Zero();
}

Vec2 force_beyond_mouth(const Mesh& mesh, const CrackPoint& mouth, int node, std::span<const Load> loads,
                        double patch) {
  // The mouth becomes a point of the loop, so that no share of a load straddles it.
  const std::vector<int> nodes = boundary_loop(mesh);
  std::vector<Vec2> loop = positions(mesh, nodes);
  const int n = static_cast<int>(nodes.size());
  int edge = 0;
  while (std::minmax(nodes[edge], nodes[(edge + 1) % n]) != std::minmax(mouth.edge[0], mouth.edge[1])) ++edge;
  loop.insert(loop.begin() + edge + 1, mouth.position);
  const bool starts_at_node = nodes[edge] == node;
  const int beyond = starts_at_node ? edge + 1 : edge;
  // N_J falls linearly from its value at the mouth to 0 at the other end.
  const double at_mouth = mouth.edge[0] == node ? 1 - mouth.fraction : mouth.fraction;
  Vec2 sum = Vec2::Zero();
  for (const Load& load : loads) {
    for (const BoundaryShare& share : boundary_shares(loop, load, patch)) {
      if (share.edge != beyond) continue;
      sum += at_mouth * (starts_at_node ? 1 - share.position : share.position) * share.weight * load.force;
    }
  }
  return sum;
}

}  // namespace xfem
