#include <catch2/catch.hpp>

#include "plates.hpp"
#include "xfem/crack/cracked_solver.hpp"
#include "xfem/crack/separation.hpp"

using namespace xfem;
using plates::kRock;
using plates::plate;
using plates::straight_crack;

namespace {

/// A crack from the boundary at `from` to inside, or from inside to the boundary.
Crack half_open(const Mesh& mesh, const Vec2& from, const Vec2& to, bool mouth_first) {
  const std::array<Vec2, 2> line{from, to};
  return place_polyline(mesh, line,
                        mouth_first ? std::array{TipState::at_boundary, TipState::active}
                                    : std::array{TipState::active, TipState::at_boundary});
}

bool separated(const Mesh& mesh, const std::vector<Crack>& cracks) {
  return is_separated(mesh, cracks, enrich(mesh, cracks));
}

}  // namespace

TEST_CASE("Cracks separate a particle if and only if they join two places of its boundary, or close a ring") {
  const Mesh mesh = plate(1, 1, 10, 10, 0.2);
  const Crack from_left = half_open(mesh, {0, 0.43}, {0.52, 0.46}, true);
  const Crack from_right = half_open(mesh, {0.34, 0.57}, {1, 0.42}, false);
  const Crack crossing = half_open(mesh, {0.47, 0}, {0.45, 0.83}, true);
  const Crack short_of_it = half_open(mesh, {0.47, 0}, {0.45, 0.28}, true);
  CHECK_FALSE(separated(mesh, {}));
  CHECK_FALSE(separated(mesh, {from_left}));
  CHECK(separated(mesh, {straight_crack(mesh, {0, 0.43}, {1, 0.51}, true)}));
  // Two cracks that pass one another side by side leave a bridge between them.
  CHECK_FALSE(separated(mesh, {from_left, from_right}));
  CHECK_FALSE(separated(mesh, {from_left, short_of_it}));
  // From the left edge along one crack and down the other to the bottom.
  CHECK(separated(mesh, {from_left, crossing}));
  CHECK(separated(mesh, {crossing, from_left}));
  // Four cracks that cross pairwise cut out a square without touching the boundary; three do not.
  const std::vector<Crack> ring{
      straight_crack(mesh, {0.15, 0.24}, {0.85, 0.26}), straight_crack(mesh, {0.73, 0.15}, {0.74, 0.85}),
      straight_crack(mesh, {0.85, 0.74}, {0.15, 0.76}), straight_crack(mesh, {0.24, 0.85}, {0.26, 0.15})};
  CHECK(separated(mesh, ring));
  CHECK_FALSE(separated(mesh, {ring[0], ring[1], ring[2]}));
}

TEST_CASE("Tips that meet at one point of an edge hold together, a passing crack lets go") {
  const Mesh mesh = plate(1, 1, 10, 10);
  const Crack whole = straight_crack(mesh, {0, 0.43}, {1, 0.51}, true);
  Crack left = whole;
  left.points.resize(9);
  left.tips[1] = TipState::active;
  Crack right = whole;
  right.points.erase(right.points.begin(), right.points.begin() + 8);
  right.tips[0] = TipState::active;
  REQUIRE(left.points.back().position == right.points.front().position);
  CHECK_FALSE(separated(mesh, {left, right}));
  // The edge between them carries: the system has a solution.
  const IntactModel model(mesh, kRock);
  CrackedSolver solver(model, plates::traction_forces(mesh, {0, -1e6, 0}));
  const std::vector<Crack> cracks{left, right};
  CHECK(solver.solve(cracks).solved);
  // With one element in common they pass through one another.
  Crack longer = whole;
  longer.points.resize(10);
  longer.tips[1] = TipState::active;
  CHECK(separated(mesh, {longer, right}));
}
