// Triangulations by flips against CGAL's exact Delaunay triangulation.
#include "xfem/meshing/flips.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/unit/xfem/outlines.hpp"
#include "xfem/meshing/delaunay.hpp"

using namespace xfem;
using namespace test_outlines;

namespace {

/// Points on the outline, `per_edge` on each edge, then up to `inner` points inside, none nearer than `apart` to
/// another.
std::vector<Vec2> random_points(common::Random& random, const Polygon& outline, int per_edge, int inner, double apart) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (int k = 0; k < per_edge; ++k) {
      points.push_back(outline[i] +
                       static_cast<double>(k) / per_edge * (outline[(i + 1) % outline.size()] - outline[i]));
    }
  }
  for (int k = 0; k < 20 * inner; ++k) {
    const Vec2 point(random.uniform(-1, 1), random.uniform(-1, 1));
    if (!common::contains(outline, point)) continue;
    double depth = 1;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
      depth = std::min(depth, common::cross(edge, point - outline[i]) / edge.norm());
    }
    const bool is_free =
        std::all_of(points.begin(), points.end(), [&](const Vec2& other) { return (other - point).norm() > apart; });
    if (is_free && depth > 0.5 * apart) points.push_back(point);
  }
  return points;
}

std::vector<std::array<int, 3>> sorted(std::vector<std::array<int, 3>> triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void check_neighbours(const Triangulation& made) {
  for (int t = 0; t < static_cast<int>(made.triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int other = made.neighbours[t][k];
      if (other < 0) continue;
      const auto& far = made.triangles[other];
      for (int end : {1, 2}) REQUIRE(std::count(far.begin(), far.end(), made.triangles[t][(k + end) % 3]) == 1);
      REQUIRE(std::count(made.neighbours[other].begin(), made.neighbours[other].end(), t) == 1);
    }
  }
}

}  // namespace

TEST_CASE("Insertion and flips give CGAL's Delaunay triangulation, also after the points have moved", "[mesh]") {
  common::Random random(21);
  int made_count = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Polygon outline = random_outline(random, random.uniform(0.3, 1));
    const int per_edge = 1 + static_cast<int>(random.index(8));
    std::vector<Vec2> points = random_points(random, outline, per_edge, 1 + static_cast<int>(random.index(60)), 0.06);
    const int boundary = per_edge * static_cast<int>(outline.size());
    std::optional<Triangulation> made = Triangulation::of(points, boundary);
    if (static_cast<int>(points.size()) == boundary) {
      REQUIRE_FALSE(made);
      continue;
    }
    REQUIRE(made);
    ++made_count;
    REQUIRE(sorted(made->triangles) == delaunay(points, boundary));
    check_neighbours(*made);
    // Moves so small that no triangle turns over.
    for (std::size_t i = boundary; i < points.size(); ++i) {
      const Vec2 from = points[i];
      points[i] += 0.02 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
      for (const auto& t : made->triangles) {
        if (std::count(t.begin(), t.end(), static_cast<int>(i)) == 0) continue;
        if (common::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]) < 1e-4) points[i] = from;
      }
    }
    REQUIRE(made->flip(points));
    REQUIRE(sorted(made->triangles) == delaunay(points, boundary));
    check_neighbours(*made);
  }
  CHECK(made_count > 250);
}

TEST_CASE("A point on an edge is left to exact arithmetic", "[mesh]") {
  const std::vector<Vec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, 0}, {0.5, 0.5}};
  CHECK_FALSE(Triangulation::of(square, 4));
  CHECK(delaunay(square, 4).size() == 6);
}
