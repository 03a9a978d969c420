#include "xfem/crack/edge_loads.hpp"

#include <algorithm>
#include <map>

#include "common/geometry/vec2.hpp"
#include "xfem/crack/path.hpp"

namespace xfem {
namespace {

/// Arc length of the start of every boundary edge, counter-clockwise from the edge that starts at `origin`.
struct BoundaryLength {
  BoundaryLength(const Mesh& mesh, int origin) {
    std::map<int, int> next;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        if (mesh.neighbours[t][k] < 0) next[mesh.triangles[t][(k + 1) % 3]] = mesh.triangles[t][(k + 2) % 3];
      }
    }
    int node = origin;
    do {
      start[node] = total;
      total += (mesh.nodes[next[node]] - mesh.nodes[node]).norm();
      node = next[node];
    } while (node != origin && start.size() <= next.size());
  }
  std::map<int, double> start;  ///< by the edge's first node
  double total = 0;
};

}  // namespace

BodyForce inertia_relief(const Mesh& mesh, std::span<const Load> loads) {
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
  Vec2 force = Vec2::Zero();
  double moment = 0;
  for (const Load& load : loads) {
    force += load.force;
    moment += common::cross(load.point - center, load.force);
  }
  return {center, -force / area, -moment / polar};
}

Vec2 integrate_body_force(PolygonView part, double area, const Vec2& gradient, const Vec2& element_center,
                          const BodyForce& body) {
  const auto value = [&](const Vec2& x) -> Vec2 {
    const double shape = 1.0 / 3 + gradient.dot(x - element_center);
    return shape * (body.translation + body.rotation * common::perpendicular(x - body.center));
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

Vec2 edge_force_beyond(const Mesh& mesh, const std::array<int, 2>& edge, double fraction, bool at_start,
                       std::span<const Load> loads, double patch) {
  const double length = (mesh.nodes[edge[1]] - mesh.nodes[edge[0]]).norm();
  // Distance from node J along the edge, as a fraction: beyond the mouth means [mouth, 1], and N_J = 1 - distance.
  const double mouth = at_start ? fraction : 1 - fraction;
  const int node = edge[at_start ? 0 : 1];
  Vec2 sum = Vec2::Zero();
  if (patch <= 0) {
    for (const Load& load : loads) {
      const BoundaryPosition place = nearest_on_boundary(mesh, load.point);
      if (std::minmax(place.edge[0], place.edge[1]) != std::minmax(edge[0], edge[1])) continue;
      const double distance = place.edge[0] == node ? place.fraction : 1 - place.fraction;
      if (distance > mouth) sum += (1 - distance) * load.force;
    }
    return sum;
  }
  const int element = edge_elements(mesh, edge)[0];
  const int local = mesh.local_edge(element, edge[0], edge[1]);
  const int origin = mesh.triangles[element][(local + 1) % 3];  // the edge starts here, counter-clockwise
  const BoundaryLength boundary(mesh, origin);
  for (const Load& load : loads) {
    const BoundaryPosition place = nearest_on_boundary(mesh, load.point);
    const double edge_length = (mesh.nodes[place.edge[1]] - mesh.nodes[place.edge[0]]).norm();
    const double middle = boundary.start.at(place.edge[0]) + place.fraction * edge_length;
    const double spread = std::min(patch, boundary.total);
    for (const double turn : {-boundary.total, 0.0, boundary.total}) {
      double low = (middle + turn - spread / 2) / length;
      double high = (middle + turn + spread / 2) / length;
      if (node != origin) {
        const double swap = 1 - low;
        low = 1 - high;
        high = swap;
      }
      low = std::max(low, mouth);
      high = std::min(high, 1.0);
      if (low >= high) continue;
      // Integral of (1 - s) over [low, high] at the density length / spread.
      sum += length / spread * (high - low) * (1 - (low + high) / 2) * load.force;
    }
  }
  return sum;
}

}  // namespace xfem
