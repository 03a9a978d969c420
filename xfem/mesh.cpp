#include "xfem/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "common/error.hpp"
#include "xfem/meshing/grading.hpp"
#include "xfem/meshing/placement.hpp"
#include "xfem/meshing/smoothing.hpp"

namespace xfem {
namespace {

constexpr int kCountPasses = 12;
constexpr int kSmoothingPasses = 6;
constexpr double kCountTolerance = 0.08;
constexpr double kGoodCosine = 0.9135;  // 24 degrees

struct Attempt {
  Placement placement;
  SizeField size;
  double error;
};

struct Triangulated {
  Placement placement;
  std::vector<std::array<int, 3>> triangles;
  double count_error;
  double worst_cosine;  ///< of the smallest angle

  bool better_than(const Triangulated& other) const {
    const bool counted = count_error <= kCountTolerance;
    const bool other_counted = other.count_error <= kCountTolerance;
    if (counted != other_counted) return counted;
    return counted ? worst_cosine < other.worst_cosine : count_error < other.count_error;
  }
};

/// The placement whose number of points is nearest to `nodes` after a few corrections of h.
Attempt place_about(PolygonView outline, double area, int nodes, const MeshGrading& grading, const Vec2& shift) {
  double perimeter = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) perimeter += (outline[(i + 1) % outline.size()] - outline[i]).norm();
  // n = A / (h^2 sqrt(3/4)) + P / (2 h) for an equilateral mesh.
  const double cell = area / std::sqrt(0.75);
  double h = (0.5 * perimeter + std::sqrt(0.25 * perimeter * perimeter + 4 * nodes * cell)) / (2 * nodes);
  double too_fine = 0, too_coarse = 0;
  std::optional<Attempt> best;
  for (int pass = 0; pass < kCountPasses; ++pass) {
    const SizeField size(outline, h, grading);
    Placement placement = place_points(outline, size, shift);
    const double count = static_cast<double>(placement.points.size());
    const double error = std::abs(count - nodes) / nodes;
    if (!best || error < best->error) best.emplace(Attempt{std::move(placement), size, error});
    if (best->error <= 0.03) break;
    (count > nodes ? too_fine : too_coarse) = h;
    h *= std::sqrt(count / nodes);
    if (too_fine > 0 && too_coarse > 0 && (h <= too_fine || h >= too_coarse)) h = std::sqrt(too_fine * too_coarse);
  }
  return std::move(*best);
}

Triangulated triangulate(PolygonView outline, double area, int nodes, const MeshGrading& grading, const Vec2& shift) {
  Attempt attempt = place_about(outline, area, nodes, grading, shift);
  std::vector<Vec2>& points = attempt.placement.points;
  auto triangles = smooth(points, static_cast<int>(attempt.placement.on_edge.size()), attempt.size, kSmoothingPasses);
  double worst = 0;
  for (const auto& [a, b, c] : triangles)
    worst = std::max(worst, smallest_angle_cosine(points[a], points[b], points[c]));
  return {std::move(attempt.placement), std::move(triangles), attempt.error, worst};
}

/// Another position of the lattice helps where the count jumps by whole rows of a thin outline, or where the lattice
/// meets the outline badly.
Triangulated triangulate_well(PolygonView outline, int nodes, const MeshGrading& grading = {}) {
  std::optional<Triangulated> best;
  for (const Vec2& shift : {Vec2(0, 0), Vec2(0.3, 0.4), Vec2(0.6, 0.2), Vec2(0.15, 0.75)}) {
    Triangulated candidate = triangulate(outline, common::area(outline), nodes, grading, shift);
    if (!best || candidate.better_than(*best)) best = std::move(candidate);
    if (best->count_error <= kCountTolerance && best->worst_cosine <= kGoodCosine) break;
  }
  return std::move(*best);
}

}  // namespace

Mesh connect(std::vector<Vec2> nodes, std::vector<std::array<int, 3>> triangles) {
  Mesh mesh;
  mesh.nodes = std::move(nodes);
  mesh.triangles = std::move(triangles);
  const std::size_t n = mesh.nodes.size();
  const std::size_t e = mesh.triangles.size();
  mesh.element_offset.assign(n + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (const int node : t) ++mesh.element_offset[node + 1];
  }
  for (std::size_t i = 0; i < n; ++i) mesh.element_offset[i + 1] += mesh.element_offset[i];
  std::vector<int> next(mesh.element_offset.begin(), mesh.element_offset.end() - 1);
  mesh.node_elements.resize(3 * e);
  for (std::size_t t = 0; t < e; ++t) {
    for (const int node : mesh.triangles[t]) mesh.node_elements[next[node]++] = static_cast<int>(t);
  }

  double length_sum = 0;
  int edges = 0;
  mesh.areas.reserve(e);
  mesh.neighbours.assign(e, {-1, -1, -1});
  for (std::size_t t = 0; t < e; ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    mesh.areas.push_back(0.5 * common::cross(mesh.nodes[b] - mesh.nodes[a], mesh.nodes[c] - mesh.nodes[a]));
    if (!(mesh.areas.back() > 0)) {
      throw common::numerical_failure("mesh: triangle " + std::to_string(t) + " has area " +
                                      std::to_string(mesh.areas.back()) + ", expected a positive one");
    }
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.triangles[t][(k + 1) % 3];
      const int to = mesh.triangles[t][(k + 2) % 3];
      for (int j = mesh.element_offset[from]; j < mesh.element_offset[from + 1]; ++j) {
        const int other = mesh.node_elements[j];
        if (other != static_cast<int>(t) && mesh.local_edge(other, from, to) >= 0) mesh.neighbours[t][k] = other;
      }
      if (mesh.neighbours[t][k] < static_cast<int>(t)) {
        length_sum += (mesh.nodes[to] - mesh.nodes[from]).norm();
        ++edges;
      }
    }
  }
  mesh.size = length_sum / edges;
  return mesh;
}

int Mesh::local_edge(int t, int a, int b) const {
  for (int k = 0; k < 3; ++k) {
    const int from = triangles[t][(k + 1) % 3];
    const int to = triangles[t][(k + 2) % 3];
    if ((from == a && to == b) || (from == b && to == a)) return k;
  }
  return -1;
}

Vec2 Mesh::centroid(int t) const {
  const auto& [a, b, c] = triangles[t];
  return (nodes[a] + nodes[b] + nodes[c]) / 3;
}

int Mesh::locate(const Vec2& point) const {
  // A point within rounding of an edge belongs to both sides, the lower index wins.
  constexpr double kTolerance = 1e-12;
  int nearest = -1;
  double nearest_distance = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const double least = std::min({common::cross(nodes[b] - nodes[a], point - nodes[a]),
                                   common::cross(nodes[c] - nodes[b], point - nodes[b]),
                                   common::cross(nodes[a] - nodes[c], point - nodes[c])});
    if (least >= -kTolerance * areas[t]) return static_cast<int>(t);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    const double distance =
        std::min({segment_distance(point, nodes[a], nodes[b]), segment_distance(point, nodes[b], nodes[c]),
                  segment_distance(point, nodes[c], nodes[a])});
    if (nearest < 0 || distance < nearest_distance) {
      nearest = static_cast<int>(t);
      nearest_distance = distance;
    }
  }
  return nearest;
}

std::vector<int> boundary_loop(const Mesh& mesh) {
  std::vector<int> successor(mesh.nodes.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbours[t][k] < 0) successor[mesh.triangles[t][(k + 1) % 3]] = mesh.triangles[t][(k + 2) % 3];
    }
  }
  const auto first = std::find_if(successor.begin(), successor.end(), [](int next) { return next >= 0; });
  std::vector<int> loop;
  int node = static_cast<int>(first - successor.begin());
  do {
    loop.push_back(node);
    node = successor[node];
  } while (node != loop.front());
  return loop;
}

Mesh make_mesh(PolygonView outline, int nodes) {
  return make_graded_mesh(outline, nodes, {});
}

Mesh make_graded_mesh(PolygonView outline, int nodes, const MeshGrading& grading) {
  const CanonicalOutline shape = canonical(outline);
  MeshGrading canonical_grading = grading;
  for (Vec2& point : canonical_grading.points) point = shape.to_canonical(point);
  Triangulated made = triangulate_well(shape.outline, nodes, canonical_grading);
  std::vector<Vec2> points = std::move(made.placement.points);
  const std::size_t boundary = made.placement.on_edge.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i < boundary) {
      const auto& [edge, t] = made.placement.on_edge[i];
      const Vec2& from = outline[edge];
      points[i] = t == 0 ? from : Vec2(from + t * (outline[(edge + 1) % outline.size()] - from));
    } else {
      points[i] = shape.from_canonical(points[i]);
    }
  }
  return connect(std::move(points), std::move(made.triangles));
}

Mesh make_mesh(const CanonicalOutline& shape, int nodes) {
  Triangulated made = triangulate_well(shape.outline, nodes);
  return connect(std::move(made.placement.points), std::move(made.triangles));
}

}  // namespace xfem
