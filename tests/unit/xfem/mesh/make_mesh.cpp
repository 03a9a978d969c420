#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "common/error.hpp"
#include "tests/unit/xfem/outlines.hpp"
#include "xfem/mesh.hpp"
#include "xfem/meshing/grading.hpp"

using namespace xfem;
using namespace test_outlines;

namespace {

double smallest_angle_degrees(const Mesh& mesh) {
  double result = 180;
  for (const auto& t : mesh.triangles) {
    result = std::min(result, smallest_corner_degrees({mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]}));
  }
  return result;
}

void check_topology(const Mesh& mesh, const Polygon& outline) {
  const int nodes = static_cast<int>(mesh.nodes.size());
  const int elements = static_cast<int>(mesh.triangles.size());
  const std::vector<int> loop = boundary_loop(mesh);
  REQUIRE(elements == 2 * nodes - 2 - static_cast<int>(loop.size()));
  double area = 0;
  for (const double a : mesh.areas) {
    REQUIRE(a > 0);
    area += a;
  }
  REQUIRE(std::abs(area / common::area(outline) - 1) < 1e-12);
  // The boundary nodes come first, start at vertex 0 and contain every vertex bit for bit, in order.
  std::size_t corner = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    REQUIRE(loop[i] == static_cast<int>(i));
    if (corner < outline.size() && mesh.nodes[i] == outline[corner]) ++corner;
  }
  REQUIRE(corner == outline.size());
  REQUIRE(mesh.nodes[0] == outline[0]);

  std::size_t entries = 0;
  for (int t = 0; t < elements; ++t) {
    if (t > 0) REQUIRE(mesh.triangles[t - 1] < mesh.triangles[t]);
    REQUIRE(mesh.triangles[t][0] == *std::min_element(mesh.triangles[t].begin(), mesh.triangles[t].end()));
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][(k + 1) % 3], b = mesh.triangles[t][(k + 2) % 3];
      REQUIRE(mesh.local_edge(t, a, b) == k);
      REQUIRE(mesh.local_edge(t, b, a) == k);
      const int other = mesh.neighbours[t][k];
      if (other < 0) {
        REQUIRE(b == (a + 1) % static_cast<int>(loop.size()));
        continue;
      }
      const int back = mesh.local_edge(other, a, b);
      REQUIRE(back >= 0);
      REQUIRE(mesh.neighbours[other][back] == t);
    }
  }
  for (int i = 0; i < nodes; ++i) {
    for (int j = mesh.element_offset[i]; j < mesh.element_offset[i + 1]; ++j) {
      const auto& t = mesh.triangles[mesh.node_elements[j]];
      REQUIRE(std::find(t.begin(), t.end(), i) != t.end());
      if (j > mesh.element_offset[i]) REQUIRE(mesh.node_elements[j - 1] < mesh.node_elements[j]);
      ++entries;
    }
  }
  REQUIRE(entries == 3 * mesh.triangles.size());
}

}  // namespace

TEST_CASE("Meshes of 500 convex outlines and of their fragments are sound and well shaped", "[mesh]") {
  common::Random random(42);
  int good_outlines = 0, fragments = 0, good_fragments = 0, poor_fragments = 0, wrong_count = 0;
  for (int k = 0; k < 500; ++k) {
    const Polygon p = random_outline(random, k % 2 == 0 ? 1.0 : random.uniform(0.3, 1));
    const int nodes = std::array{28, 75, 75, 150, 300}[k % 5];
    const Mesh mesh = make_mesh(p, nodes);
    check_topology(mesh, p);
    REQUIRE(std::abs(static_cast<double>(mesh.nodes.size()) / nodes - 1) <= 0.1);
    if (smallest_corner_degrees(p) >= 60) {
      ++good_outlines;
      REQUIRE(smallest_angle_degrees(mesh) >= 22);
    }

    const Vec2 through(random.uniform(-0.5, 0.5), random.uniform(-0.25, 0.25));
    const Polygon fragment = left_part(p, through, Vec2(random.uniform(-1, 1), random.uniform(-1, 1)));
    if (fragment.size() < 3 || !common::outline_defect(fragment).empty()) continue;
    ++fragments;
    const Mesh piece = make_mesh(fragment, nodes);
    check_topology(piece, fragment);
    wrong_count += std::abs(static_cast<double>(piece.nodes.size()) / nodes - 1) > 0.1;
    const bool fine_enough = shortest_edge(fragment) > 0.125 * piece.size;
    if (smallest_corner_degrees(fragment) >= 60 && fine_enough) {
      ++good_fragments;
      poor_fragments += smallest_angle_degrees(piece) < 20;
    }
  }
  CHECK(good_outlines > 450);
  CHECK(fragments > 450);
  CHECK(good_fragments > 300);
  CHECK(poor_fragments <= good_fragments / 100);
  CHECK(wrong_count <= 5);
}

TEST_CASE("Extreme outlines and node counts give valid meshes", "[mesh]") {
  const std::vector<Polygon> outlines{
      {{0, 0}, {50, 0}, {50, 1}, {0, 1}},                              // sliver
      {{0, 0}, {50, 0.5}, {0, 1}},                                     // needle
      {{0, 0}, {1, 0}, {1, 0.01}, {0.5, 0.8}, {0.49, 0.8}, {0, 0.4}},  // edges of 1 %
      {{0, 0}, {1, 0}, {1, 1}, {1e-5, 1}, {0, 1 - 1e-5}},              // a cut-off corner
      {{0, 0}, {0.5, -1e-10}, {1, 0}, {1, 1}, {0, 1}},                 // a nearly straight corner
      {{0, 0}, {0.3, 0}, {0.7, 0}, {1, 0}, {1, 1}, {0.7, 1}, {0, 1}},  // corners on a straight edge
      regular(3, 1),
      regular(64, 0.25),
      regular(8, 1, 0.1)};
  for (const Polygon& p : outlines) {
    for (const int nodes : {3, 28, 75, 300, 5000}) {
      INFO("outline of " << p.size() << " corners, " << nodes << " nodes");
      const Mesh mesh = make_mesh(p, nodes);
      check_topology(mesh, p);
      if (nodes >= 300) CHECK(std::abs(static_cast<double>(mesh.nodes.size()) / nodes - 1) <= 0.1);
    }
  }
  CHECK_THROWS_AS(make_mesh(Polygon{{0, 0}, {1, 0}}, 75), common::Error);
  CHECK_THROWS_AS(make_mesh(Polygon{{0, 0}, {0, 1}, {1, 0}}, 75), common::Error);
}

TEST_CASE("A graded mesh is finer at its points and keeps soundness, angles and number of nodes", "[mesh]") {
  common::Random random(31);
  for (int k = 0; k < 60; ++k) {
    const Polygon p = random_outline(random, random.uniform(0.5, 1));
    const int nodes = std::array{75, 150, 300, 1200}[k % 4];
    const double ratio = std::array{2.0, 4.0, 8.0}[k % 3];
    const Vec2 corner = p[0], inside = 0.3 * p[2] + 0.3 * p[4];
    const Mesh mesh = make_graded_mesh(p, nodes, {{corner, inside}, ratio});
    INFO("outline " << k << ", " << nodes << " nodes, ratio " << ratio);
    check_topology(mesh, p);
    CHECK(std::abs(static_cast<double>(mesh.nodes.size()) / nodes - 1) <= 0.1);
    CHECK(smallest_angle_degrees(mesh) >= std::min(20.0, 0.95 * smallest_corner_degrees(p)));
    const Mesh even = make_mesh(p, nodes);
    for (const Vec2& point : {corner, inside}) {
      const int fine = mesh.locate(point), coarse = even.locate(point);
      if (nodes > 75) CHECK(mesh.areas[fine] < even.areas[coarse] / (0.5 * ratio));
    }
  }
  const Polygon p = random_outline(random, 0.7);
  CHECK(make_graded_mesh(p, 150, {{p[1]}, 1}).nodes == make_mesh(p, 150).nodes);
}

TEST_CASE("Slivers are meshed with the angles that their corners allow and the nodes that were asked for", "[mesh]") {
  for (const double ratio : {5.0, 20.0, 50.0}) {
    for (const int nodes : {75, 150, 300, 1200}) {
      INFO("ratio " << ratio << ", " << nodes << " nodes");
      const Polygon bar{{0, 0}, {ratio, 0}, {ratio, 1}, {0, 1}};
      const Mesh mesh = make_mesh(bar, nodes);
      CHECK(smallest_angle_degrees(mesh) >= 30);
      CHECK(std::abs(static_cast<double>(mesh.nodes.size()) / nodes - 1) <= 0.1);
      const Polygon needle{{0, 0}, {ratio, 0.5}, {0, 1}};
      const Mesh sharp = make_mesh(needle, nodes);
      CHECK(smallest_angle_degrees(sharp) >= std::min(20.0, 0.95 * smallest_corner_degrees(needle)));
      CHECK(std::abs(static_cast<double>(sharp.nodes.size()) / nodes - 1) <= 0.1);
    }
  }
}

TEST_CASE("A mesh does not depend on place and scale, nor on what was meshed before", "[mesh]") {
  common::Random random(9);
  int same_topology = 0;
  for (int k = 0; k < 50; ++k) {
    const Polygon p = k == 0 ? regular(4, 1) : random_outline(random, random.uniform(0.4, 1));
    const Mesh mesh = make_mesh(p, 150);
    const Mesh again = make_mesh(p, 150);
    REQUIRE(mesh.triangles == again.triangles);
    REQUIRE(mesh.nodes == again.nodes);
    Polygon moved;
    for (const Vec2& v : p) moved.push_back(0.23 * v + Vec2(3, -2));
    const Mesh other = make_mesh(moved, 150);
    if (other.triangles != mesh.triangles) continue;
    ++same_topology;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      REQUIRE((0.23 * mesh.nodes[i] + Vec2(3, -2) - other.nodes[i]).norm() < 1e-13);
    }
  }
  CHECK(same_topology == 50);
}

TEST_CASE("Points are found in the triangle that holds them, on ties in the lowest", "[mesh]") {
  const Polygon p = regular(7, 1);
  const Mesh mesh = make_mesh(p, 150);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    CHECK(mesh.locate((mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]) / 3) == t);
    for (int k = 0; k < 3; ++k) {
      const Vec2 middle =
          0.5 * (mesh.nodes[mesh.triangles[t][(k + 1) % 3]] + mesh.nodes[mesh.triangles[t][(k + 2) % 3]]);
      const int other = mesh.neighbours[t][k];
      CHECK(mesh.locate(middle) == (other < 0 ? t : std::min(t, other)));
    }
  }
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    CHECK(mesh.locate(mesh.nodes[i]) == mesh.node_elements[mesh.element_offset[i]]);
  }
  // Outside: the nearest triangle has the nearest boundary edge.
  const int outside = mesh.locate(1.01 * 0.5 * (mesh.nodes[0] + mesh.nodes[1]));
  CHECK(mesh.local_edge(outside, 0, 1) >= 0);
}

TEST_CASE("Inverted triangles are refused", "[mesh]") {
  CHECK_THROWS_AS(connect({{0, 0}, {1, 0}, {0, 1}}, {{0, 2, 1}}), common::Error);
  const Mesh one = connect({{0, 0}, {3, 0}, {0, 4}}, {{0, 1, 2}});
  CHECK(one.size == Approx(4));
  CHECK(one.areas[0] == Approx(6));
  CHECK(boundary_loop(one) == std::vector<int>{0, 1, 2});
}
