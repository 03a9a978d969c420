#include "xfem/meshing/flips.hpp"

#include <algorithm>
#include <utility>

namespace xfem {

using common::Vec2;

namespace {

constexpr double kRounding = 1e-12;  // of the sine of the sum of two angles
constexpr double kNearEdge = 1e-9;   // distance from an edge over its length
constexpr std::size_t kMostFlipsPerTriangle = 32;

}  // namespace

Triangulation::Triangulation(std::vector<std::array<int, 3>> counter_clockwise, std::size_t points)
    : triangles(std::move(counter_clockwise)), neighbours(triangles.size(), {-1, -1, -1}) {
  // Edges that have met one of their triangles, listed at their lower node.
  struct Side {
    int other_node, triangle, local, following;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  std::vector<int> first(points, -1);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]);
      int at = first[low];
      while (at >= 0 && sides[at].other_node != high) at = sides[at].following;
      if (at < 0) {
        sides.push_back({high, t, k, first[low]});
        first[low] = static_cast<int>(sides.size()) - 1;
      } else {
        neighbours[t][k] = sides[at].triangle;
        neighbours[sides[at].triangle][sides[at].local] = t;
      }
    }
  }
}

std::optional<Triangulation> Triangulation::of(std::span<const Vec2> points, int boundary) {
  const int count = static_cast<int>(points.size());
  if (boundary >= count) return std::nullopt;
  std::vector<std::array<int, 3>> fan;
  fan.reserve(2 * points.size());
  for (int k = 0; k < boundary; ++k) fan.push_back({boundary, k, k + 1 < boundary ? k + 1 : 0});
  Triangulation result(std::move(fan), points.size());
  std::vector<std::pair<int, int>> open;
  if (!result.flip(points)) return std::nullopt;
  int t = 0;
  for (int node = boundary + 1; node < count; ++node) {
    // Walk across the edge that the point is farthest beyond.
    const Vec2& point = points[node];
    for (int steps = 0;; ++steps) {
      double least = 0;
      int across = -1;
      bool is_near = false;
      for (int k = 0; k < 3; ++k) {
        const Vec2& from = points[result.triangles[t][(k + 1) % 3]];
        const Vec2 edge = points[result.triangles[t][(k + 2) % 3]] - from;
        const double side = common::cross(edge, point - from) / edge.squaredNorm();
        is_near = is_near || (side < kNearEdge && side > -kNearEdge);
        if (side < least) {
          least = side;
          across = k;
        }
      }
      if (across < 0) {
        if (is_near) return std::nullopt;
        break;
      }
      t = result.neighbours[t][across];
      if (t < 0 || steps > count) return std::nullopt;
    }
    // Triangle (a, b, c) becomes (node, b, c), (node, c, a) and (node, a, b).
    const auto [a, b, c] = result.triangles[t];
    const auto [beyond_bc, beyond_ca, beyond_ab] = result.neighbours[t];
    const int second = static_cast<int>(result.triangles.size()), third = second + 1;
    result.triangles[t] = {node, b, c};
    result.neighbours[t] = {beyond_bc, second, third};
    result.triangles.push_back({node, c, a});
    result.neighbours.push_back({beyond_ca, third, t});
    result.triangles.push_back({node, a, b});
    result.neighbours.push_back({beyond_ab, t, second});
    for (const auto& [beyond, own] : {std::pair(beyond_ca, second), std::pair(beyond_ab, third)}) {
      if (beyond < 0) continue;
      for (int& neighbour : result.neighbours[beyond]) {
        if (neighbour == t) neighbour = own;
      }
    }
    open.assign({{t, 0}, {second, 0}, {third, 0}});
    if (!result.flip(points, open)) return std::nullopt;
  }
  return result;
}

bool Triangulation::flip(std::span<const Vec2> points) {
  std::vector<std::pair<int, int>> open;  // triangle and local edge
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (neighbours[t][k] > t) open.emplace_back(t, k);
    }
  }
  return flip(points, open);
}

bool Triangulation::flip(std::span<const Vec2> points, std::vector<std::pair<int, int>>& open) {
  const auto local_of = [&](int t, int neighbour) {
    return neighbours[t][0] == neighbour ? 0 : neighbours[t][1] == neighbour ? 1 : 2;
  };
  std::size_t left = kMostFlipsPerTriangle * triangles.size();
  while (!open.empty()) {
    const auto [t, k] = open.back();
    open.pop_back();
    const int o = neighbours[t][k];
    if (o < 0) continue;
    const int j = local_of(o, t);
    const int p = triangles[t][k], a = triangles[t][(k + 1) % 3], b = triangles[t][(k + 2) % 3], q = triangles[o][j];
    const Vec2 pa = points[a] - points[p], pb = points[b] - points[p];
    const Vec2 qa = points[a] - points[q], qb = points[b] - points[q];
    const double sin_p = common::cross(pa, pb), cos_p = pa.dot(pb);
    const double sin_q = common::cross(qb, qa), cos_q = qa.dot(qb);
    const double sine = sin_p * cos_q + cos_p * sin_q;
    if (!(sine < 0) || sine * sine < kRounding * kRounding * pa.squaredNorm() * pb.squaredNorm() * qa.squaredNorm() *
                                         qb.squaredNorm()) {
      continue;
    }
    if (left-- == 0) return false;
    // (p, a, b) and (q, b, a) become (p, a, q) and (q, b, p).
    const int beyond_bp = neighbours[t][(k + 1) % 3], beyond_pa = neighbours[t][(k + 2) % 3];
    const int beyond_aq = neighbours[o][(j + 1) % 3], beyond_qb = neighbours[o][(j + 2) % 3];
    triangles[t] = {p, a, q};
    neighbours[t] = {beyond_aq, o, beyond_pa};
    triangles[o] = {q, b, p};
    neighbours[o] = {beyond_bp, t, beyond_qb};
    if (beyond_aq >= 0) neighbours[beyond_aq][local_of(beyond_aq, o)] = t;
    if (beyond_bp >= 0) neighbours[beyond_bp][local_of(beyond_bp, t)] = o;
    open.insert(open.end(), {{t, 0}, {t, 2}, {o, 0}, {o, 2}});
  }
  return true;
}

}  // namespace xfem
