#include <catch2/catch.hpp>
#include <cmath>

#include "plates.hpp"

using namespace xfem;
using plates::plate;
using plates::straight_crack;

TEST_CASE("The topological sides of a segment are the geometric ones") {
  const Mesh mesh = plate(2, 1, 12, 6, 0.3);
  common::Random random(3);
  int segments = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec2 from(random.uniform(0, 2), random.uniform(0, 1));
    const Vec2 to(random.uniform(0, 2), random.uniform(0, 1));
    const Crack crack = straight_crack(mesh, from, to);
    for (std::size_t i = 0; i + 1 < crack.points.size(); ++i) {
      const CrackPoint &a = crack.points[i], &b = crack.points[i + 1];
      const int element = segment_element(mesh, a, b);
      REQUIRE(element >= 0);
      const auto sides = segment_sides(mesh, element, a, b);
      for (int k = 0; k < 3; ++k) {
        const Vec2& node = mesh.nodes[mesh.triangles[element][k]];
        CHECK((common::cross(b.position - a.position, node - a.position) > 0) == (sides[k] > 0));
        ++segments;
      }
    }
  }
  CHECK(segments > 1000);
}

TEST_CASE("A polyline is placed on the mesh edges that it crosses") {
  const Mesh mesh = plate(2, 1, 12, 6, 0.3);
  common::Random random(11);
  int placed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec2 from(random.uniform(0.1, 1.9), random.uniform(0.1, 0.9));
    const Vec2 to(random.uniform(0.1, 1.9), random.uniform(0.1, 0.9));
    const Crack crack = straight_crack(mesh, from, to);
    if (crack.points.empty()) {
      CHECK((to - from).norm() < 0.6);
      continue;
    }
    ++placed;
    CHECK(crack_defect(mesh, crack).empty());
    for (const CrackPoint& point : crack.points) {
      const Vec2 a = mesh.nodes[point.edge[0]];
      const Vec2 b = mesh.nodes[point.edge[1]];
      CHECK((a + point.fraction * (b - a) - point.position).norm() < 1e-15);
      // On the line, but for the clearance that keeps it off the nodes.
      const double off = std::abs(common::cross(to - from, point.position - from)) / (to - from).norm();
      CHECK(off <= 1.0001 * kEdgeClearance * (b - a).norm());
    }
    // The ends are cut back by less than an element.
    CHECK((crack.points.front().position - from).norm() < 0.45);
    CHECK((crack.points.back().position - to).norm() < 0.45);
  }
  CHECK(placed > 250);
}

TEST_CASE("A crack's own polyline is placed where it was, mouths included") {
  const Mesh mesh = plate(2, 1, 12, 6, 0.3);
  for (const bool mouths : {false, true}) {
    const Crack crack = straight_crack(mesh, mouths ? Vec2(0.71, 0) : Vec2(0.71, 0.23),
                                       mouths ? Vec2(1.13, 1) : Vec2(1.13, 0.83), mouths);
    REQUIRE(crack.points.size() > 4);
    CHECK((crack.tips[1] == TipState::at_boundary) == mouths);
    CHECK((crack.tips[0] == TipState::at_boundary) == mouths);
    std::vector<Vec2> polyline;
    for (const CrackPoint& point : crack.points) polyline.push_back(point.position);
    // Ends inside stand on an edge, where rounding decides whether that edge counts as crossed.
    const Crack again = place_polyline(mesh, polyline, crack.tips);
    const std::size_t cut = mouths ? 0 : 1;
    REQUIRE(again.points.size() + cut >= crack.points.size());
    const std::size_t shift = crack.points.size() - again.points.size();
    for (std::size_t i = 0; i < again.points.size(); ++i) {
      CHECK(again.points[i].edge == crack.points[i + shift].edge);
      CHECK(again.points[i].fraction == Approx(crack.points[i + shift].fraction).margin(1e-12));
    }
  }
}

TEST_CASE("A folded polyline still gives a valid crack") {
  const Mesh mesh = plate(2, 1, 12, 6, 0.3);
  common::Random random(5);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<Vec2> polyline;
    for (int i = 0; i < 6; ++i) polyline.push_back({random.uniform(-0.1, 2.1), random.uniform(-0.1, 1.1)});
    const Crack crack = place_polyline(mesh, polyline, {TipState::active, TipState::at_crack});
    if (!crack.points.empty()) CHECK(crack_defect(mesh, crack) == "");
  }
}

TEST_CASE("A crack that does not fit its mesh is named as such") {
  const Mesh mesh = plate(2, 1, 4, 2);
  Crack crack = straight_crack(mesh, {0.1, 0.3}, {1.9, 0.35});
  REQUIRE(crack.points.size() > 3);
  CHECK(crack_defect(mesh, crack).empty());
  Crack gap = crack;
  gap.points.erase(gap.points.begin() + 1);
  CHECK_THAT(crack_defect(mesh, gap), Catch::Contains("no element in common"));
  Crack twice = crack;
  twice.points.push_back(twice.points[twice.points.size() - 2]);
  CHECK_THAT(crack_defect(mesh, twice), Catch::Contains("second time"));
  Crack unknown = crack;
  unknown.points[0].edge = {0, 14};
  CHECK_THAT(crack_defect(mesh, unknown), Catch::Contains("does not have"));
  Crack outside = crack;
  outside.points[0].fraction = 1.5;
  CHECK_THAT(crack_defect(mesh, outside), Catch::Contains("inside its edge"));
}

TEST_CASE("A line from boundary to boundary is placed as a crack with two mouths, through nodes and along edges too") {
  const Mesh mesh = plates::plate(1, 1, 8, 8);
  const auto check = [&](const Vec2& from, const Vec2& to) {
    for (const auto& [first, last] : {std::pair{from, to}, {to, from}}) {
      INFO(first.x() << " " << first.y() << " to " << last.x() << " " << last.y());
      const Crack crack = plates::straight_crack(mesh, first, last, true);
      REQUIRE(crack.points.size() > 2);
      CHECK(crack_defect(mesh, crack).empty());
      CHECK(on_boundary(mesh, crack.points.front()));
      CHECK(on_boundary(mesh, crack.points.back()));
      CHECK((crack.points.front().position - first).norm() < 0.05 * mesh.size);
      CHECK((crack.points.back().position - last).norm() < 0.05 * mesh.size);
    }
  };
  for (int i = 1; i < 8; ++i) {
    check({0, i / 8.0}, {1, i / 8.0});
    check({i / 8.0, 0}, {i / 8.0, 1});
    check({0, i / 8.0}, {1, 1 - i / 8.0});
  }
  check({0, 0}, {1, 1});
  check({0, 1}, {1, 0});
  check({0, 0.25}, {1, 0.5});
}
