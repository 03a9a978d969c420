#include "xfem/meshing/smoothing.hpp"

#include <algorithm>
#include <cmath>

#include "xfem/meshing/delaunay.hpp"
#include "xfem/meshing/flips.hpp"

namespace xfem {

using common::Vec2;

double smallest_angle_cosine(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, bc = c - b, ca = a - c;
  if (common::cross(ab, bc) <= 0) return 2;
  const double x = ab.squaredNorm(), y = bc.squaredNorm(), z = ca.squaredNorm();
  // The smallest angle lies opposite to the shortest edge.
  if (x <= y && x <= z) return (y + z - x) / (2 * std::sqrt(y * z));
  if (y <= z) return (z + x - y) / (2 * std::sqrt(z * x));
  return (x + y - z) / (2 * std::sqrt(x * y));
}

namespace {

// Cosine of 33 degrees: nodes all of whose triangles have a smaller angle above that stay.
constexpr double kGoodEnough = 0.8387;

using Triangles = std::vector<std::array<int, 3>>;

/// Triangles around each node.
struct Stars {
  std::vector<int> offset, triangle;

  Stars(const Triangles& triangles, std::size_t nodes) : offset(nodes + 1, 0), triangle(3 * triangles.size()) {
    for (const auto& t : triangles) {
      for (const int node : t) ++offset[node + 1];
    }
    for (std::size_t i = 0; i < nodes; ++i) offset[i + 1] += offset[i];
    std::vector<int> next(offset.begin(), offset.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (const int node : triangles[t]) triangle[next[node]++] = static_cast<int>(t);
    }
  }
};

double worst_of_star(const std::vector<Vec2>& points, const Triangles& triangles, const Stars& stars, int node,
                     const Vec2& position) {
  double worst = 0;
  for (int k = stars.offset[node]; k < stars.offset[node + 1]; ++k) {
    const auto& t = triangles[stars.triangle[k]];
    const auto at = [&](int i) { return t[i] == node ? position : points[t[i]]; };
    worst = std::max(worst, smallest_angle_cosine(at(0), at(1), at(2)));
  }
  return worst;
}

/// Where the neighbours would be at their wanted distances: their mean, each pulled along its edge to the wanted
/// length.
Vec2 relaxed_position(const std::vector<Vec2>& points, const Triangles& triangles, const Stars& stars, int node,
                      const SizeField& size) {
  Vec2 sum = Vec2::Zero();
  int count = 0;
  for (int k = stars.offset[node]; k < stars.offset[node + 1]; ++k) {
    const auto& t = triangles[stars.triangle[k]];
    const int local = t[0] == node ? 0 : t[1] == node ? 1 : 2;
    const Vec2& other = points[t[(local + 1) % 3]];
    const Vec2 edge = points[node] - other;
    const double length = edge.norm();
    const double wanted = size(0.5 * (points[node] + other));
    sum += other + edge * (wanted / length);
    ++count;
  }
  return sum / count;
}

}  // namespace

std::vector<std::array<int, 3>> smooth(std::vector<Vec2>& points, int boundary, const SizeField& size, int passes) {
  const auto anew = [&] { return Triangulation(delaunay(points, boundary), points.size()); };
  std::optional<Triangulation> made = Triangulation::of(points, boundary);
  Triangulation triangulation = made ? std::move(*made) : anew();
  Triangles& triangles = triangulation.triangles;
  for (int pass = 0; pass < passes; ++pass) {
    const Stars stars(triangles, points.size());
    bool moved = false;
    for (int node = boundary; node < static_cast<int>(points.size()); ++node) {
      const double before = worst_of_star(points, triangles, stars, node, points[node]);
      if (before < kGoodEnough) continue;
      Vec2 best = points[node];
      double best_worst = before;
      Vec2 mean = Vec2::Zero();
      for (int k = stars.offset[node]; k < stars.offset[node + 1]; ++k) {
        const auto& t = triangles[stars.triangle[k]];
        mean += points[t[0]] + points[t[1]] + points[t[2]] - points[node];
      }
      mean /= 2.0 * (stars.offset[node + 1] - stars.offset[node]);
      const Vec2 relaxed = relaxed_position(points, triangles, stars, node, size);
      for (const Vec2& target : {mean, relaxed}) {
        for (const double step : {1.0, 0.5, 0.25}) {
          const Vec2 candidate = points[node] + step * (target - points[node]);
          const double worst = worst_of_star(points, triangles, stars, node, candidate);
          if (worst < best_worst) {
            best_worst = worst;
            best = candidate;
          }
        }
      }
      if (best_worst < before) {
        points[node] = best;
        moved = true;
      }
    }
    if (!moved) break;
    if (!triangulation.flip(points)) triangulation = anew();
  }
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return std::move(triangles);
}

}  // namespace xfem
