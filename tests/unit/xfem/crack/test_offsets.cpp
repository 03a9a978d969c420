// Cracks at every distance from nodes: where they run exactly, and where production keeps them.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "plates.hpp"
#include "tests/robustness/xfem/full_system.hpp"
#include "xfem/crack/cracked_solver.hpp"
#include "xfem/crack/dense_spd.hpp"
#include "xfem/crack/separation.hpp"

using namespace xfem;
using plates::kRock;
using plates::plate;
using plates::straight_crack;

namespace {

constexpr int kCells = 8;
/// Of a line from the row of nodes below it, in cells; 0 stands for as near as a fraction can be.
constexpr double kOffsets[] = {1e-28, 1e-20, 1e-16, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3};

/// Through (from, to: cells along the row) the unit plate above row `row`, its points wherever they fall.
Crack level_crack(const Mesh& mesh, int row, double offset, int from, int to) {
  const auto node = [](int i, int j) { return j * (kCells + 1) + i; };
  const auto point = [&](int a, int b) {
    return CrackPoint{{a, b}, offset, mesh.nodes[a] + offset * (mesh.nodes[b] - mesh.nodes[a])};
  };
  Crack crack;
  for (int i = from; i <= to; ++i) {
    crack.points.push_back(point(node(i, row), node(i, row + 1)));
    if (i < to) crack.points.push_back(point(node(i, row), node(i + 1, row + 1)));
  }
  if (from == 0) crack.tips[0] = TipState::at_boundary;
  if (to == kCells) crack.tips[1] = TipState::at_boundary;
  return crack;
}

/// Largest strain, over all parts of all elements, of two small rigid motions on the two sides of a through cut.
double strain_of_two_motions(const IntactModel& model, const Crack& crack, double smallest_support) {
  const Mesh& mesh = model.mesh();
  const auto motion = [](int side, const Vec2& x) -> Vec2 {
    return side > 0 ? Vec2(Vec2(0.3, -0.2) + 0.7 * common::perpendicular(x))
                    : Vec2(Vec2(-0.1, 0.5) - 0.4 * common::perpendicular(x));
  };
  const Enrichment enrichment = enrich(mesh, {&crack, 1}, smallest_support);
  std::map<int, int> side;
  for (const CrackSegment& segment : enrichment.segments) {
    for (int k = 0; k < 3; ++k) side[mesh.triangles[segment.element][k]] = segment.side[k];
  }
  // What is not beside the crack takes the side of its neighbours, from element to element.
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& triangle : mesh.triangles) {
      int known = 0;
      for (const int node : triangle) known += side.contains(node) ? side[node] : 0;
      for (const int node : triangle) {
        if (known == 0 || side.contains(node)) continue;
        side[node] = known > 0 ? 1 : -1;
        changed = true;
      }
    }
  }
  CrackedState state;
  state.u.resize(model.dofs());
  state.q.resize(2 * static_cast<Eigen::Index>(enrichment.functions.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    state.u.segment<2>(2 * i) = motion(side[static_cast<int>(i)], mesh.nodes[i]);
  }
  for (std::size_t f = 0; f < enrichment.functions.size(); ++f) {
    const Vec2& x = mesh.nodes[enrichment.functions[f].node];
    state.q.segment<2>(2 * f) = (motion(1, x) - motion(-1, x)) / 2;
  }
  double largest = 0;
  growth_walks::for_each_part(model, enrichment, [&](double, std::span<const growth_walks::Shape> shapes) {
    Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
    for (const growth_walks::Shape& shape : shapes) {
      const Vec2 value = shape.row < model.dofs() ? Vec2(state.u.segment<2>(shape.row))
                                                  : Vec2(state.q.segment<2>(shape.row - model.dofs()));
      gradient += value * shape.gradient.transpose();
    }
    largest = std::max(largest, (gradient + gradient.transpose()).cwiseAbs().maxCoeff());
  });
  return largest;
}

}  // namespace

TEST_CASE("Two rigid motions across a cut leave no strain at any offset of the cut from a node") {
  for (const double jitter : {0.0, 0.25}) {
    const IntactModel model(plate(1, 1, kCells, kCells, jitter), kRock);
    for (const double offset : kOffsets) {
      INFO("offset " << offset << ", jitter " << jitter);
      // On the line itself every part counts, however small; from above and from below.
      for (const double place : {offset, 1 - offset}) {
        if (place == 1) continue;
        const Crack exact = level_crack(model.mesh(), 3, place, 0, kCells);
        REQUIRE(crack_defect(model.mesh(), exact).empty());
        CHECK(strain_of_two_motions(model, exact, 0) < 1e-12);
        CHECK(is_separated(model.mesh(), {&exact, 1}, enrich(model.mesh(), {&exact, 1})));
      }
    }
    for (const double offset : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.02, 0.1, 0.3}) {
      for (const double sign : {-1.0, 1.0}) {
        // As production places it, clear of nodes and with the smallest supports dropped.
        const double y = (3 + sign * offset) / kCells;
        const Crack placed = straight_crack(model.mesh(), {0, y}, {1, y}, true);
        INFO("offset " << sign * offset << ", jitter " << jitter);
        REQUIRE(placed.tips[0] == TipState::at_boundary);
        REQUIRE(placed.tips[1] == TipState::at_boundary);
        CHECK(strain_of_two_motions(model, placed, kSmallestSupport) < 1e-12);
      }
    }
  }
}

TEST_CASE("A through cut has six motions without strain, and is not solved") {
  const IntactModel model(plate(1, 1, kCells, kCells, 0.25), kRock);
  const Crack through = level_crack(model.mesh(), 3, 0.3, 0, kCells);
  const Crack partial = level_crack(model.mesh(), 3, 0.3, 0, kCells - 2);
  for (const auto& [crack, motions] : {std::pair{through, 6}, {partial, 3}}) {
    const Enrichment enrichment = enrich(model.mesh(), {&crack, 1});
    const Eigen::MatrixXd stiffness = Eigen::MatrixXd(growth_walks::scaled_stiffness(model, enrichment));
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, Eigen::EigenvaluesOnly).eigenvalues();
    CHECK(eigenvalues[motions - 1] < 1e-13);
    CHECK(eigenvalues[motions] > 1e-5);
    CHECK(is_separated(model.mesh(), {&crack, 1}, enrichment) == (motions > 3));
    CrackedSolver solver(model, plates::traction_forces(model.mesh(), {0, -1e6, 0}));
    CHECK(solver.solve({&crack, 1}).solved == (motions == 3));
  }
}

TEST_CASE("Uniform stress along a crack passes it undisturbed at any offset from a node") {
  const IntactModel model(plate(1, 1, kCells, kCells, 0.0), kRock);
  for (const double sigma : {1e6, -1e6}) {
    CrackedSolver solver(model, plates::traction_forces(model.mesh(), {sigma, 0, 0}));
    for (const double offset : kOffsets) {
      const Crack crack = level_crack(model.mesh(), 3, offset, 2, 6);
      const CrackedState state = solver.solve({&crack, 1});
      INFO("offset " << offset);
      REQUIRE(state.solved);
      REQUIRE(state.q.size() > 4);
      for (const Stress& s : state.stress) {
        CHECK(std::abs(s.xx - sigma) + std::abs(s.yy) + std::abs(s.xy) < 1e-12 * std::abs(sigma));
      }
    }
  }
}

TEST_CASE("The condition of the enriched system does not depend on how little of an element is cut off") {
  // Condition number of the enriched dofs with the standard ones eliminated, at part areas from 1e-1 to 1e-56 of an
  // element, none dropped: as it is it grows like 1 / area, with the diagonal scaled to 1 it stays.
  const IntactModel model(plate(1, 1, kCells, kCells, 0.0), kRock);
  for (const double offset : kOffsets) {
    const Crack crack = level_crack(model.mesh(), 3, offset, 2, 6);
    const Enrichment enrichment = enrich(model.mesh(), {&crack, 1}, 0);
    double smallest = 1;
    for (const CutElement& element : enrichment.cut) {
      for (const ElementPart& part : element.parts) {
        smallest = std::min(smallest, part.area / model.mesh().areas[element.element]);
      }
    }
    const Eigen::MatrixXd scaled = Eigen::MatrixXd(growth_walks::scaled_stiffness(model, enrichment));
    const Eigen::Index standard = model.dofs(), size = scaled.rows() - standard;
    Eigen::MatrixXd k = scaled.topLeftCorner(standard, standard);
    for (const int dof : model.fixed_dofs()) {
      k.row(dof).setZero();
      k.col(dof).setZero();
      k(dof, dof) = 1;
    }
    Eigen::MatrixXd coupling = scaled.topRightCorner(standard, size);
    for (const int dof : model.fixed_dofs()) coupling.row(dof).setZero();
    Eigen::MatrixXd schur = scaled.bottomRightCorner(size, size) - coupling.transpose() * k.llt().solve(coupling);
    const Eigen::VectorXd diagonal = schur.diagonal().cwiseSqrt().cwiseInverse();
    schur = diagonal.asDiagonal() * schur * diagonal.asDiagonal();
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(schur, Eigen::EigenvaluesOnly).eigenvalues();
    const double condition = eigenvalues[size - 1] / eigenvalues[0];
    CAPTURE(offset, smallest, condition);
    CHECK(eigenvalues[0] > 0);
    CHECK(condition < 1e4);
    // And it is solved: nothing stays unbalanced.
    const std::vector<Load> loads{{{0.4, 0}, {0, -1e6}}, {{0.6, 1}, {0, 1e6}}};
    CrackedSolver solver(model, loads);
    const CrackedState state = solver.solve({&crack, 1}, 0);
    REQUIRE(state.solved);
    const growth_walks::Residual residual =
        growth_walks::residual_of(model, loads, 0, Polygon{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, state);
    CHECK(residual.is_finite);
    CHECK(residual.over_load < 1e-12);
    CHECK(residual.virial < 1e-14);
  }
}

TEST_CASE("A second cut of no length leaves the parts of an element as they are") {
  // Both its points stand on one node to within rounding: its line has no direction, only its topology tells the sides.
  const Mesh mesh = plate(1, 1, kCells, kCells);
  const Crack level = level_crack(mesh, 3, 0.4, 1, 7);
  const int corner = 3 * (kCells + 1) + 4, right = corner + 1, above = right + kCells + 1;
  const auto beside = [&](int a, int b) { return CrackPoint{{a, b}, 1e-28, mesh.nodes[a]}; };
  Crack tiny;
  tiny.points = {beside(corner, right), beside(corner, above)};
  REQUIRE(crack_defect(mesh, tiny).empty());
  const std::vector<Crack> cracks{level, tiny};
  const Enrichment enrichment = enrich(mesh, cracks);
  bool met = false;
  for (const CutElement& element : enrichment.cut) {
    double sum = 0;
    for (const ElementPart& part : element.parts) sum += part.area;
    CHECK(sum == Approx(mesh.areas[element.element]).epsilon(1e-14));
    met = met || element.segments.size() == 2;
  }
  CHECK(met);
}

TEST_CASE("A mouth on a node takes the loads of the edge beyond it") {
  // The mouth's position is the node's own: the edge beyond it is the whole edge, seen from this node.
  const IntactModel model(plate(1, 1, kCells, kCells), kRock);
  for (const double place : {0.3, 0.02, 0.9}) {
    const std::vector<Load> loads{{{0, (3 + place) / kCells}, {3e5, 1e6}}, {{1, 0.5}, {-3e5, -1e6}}};
    for (const double patch : {0.0, 0.05}) {
      const EdgeLoads edge_loads(model, loads, patch);
      const int lower = 3 * (kCells + 1), upper = lower + kCells + 1;
      const auto force = [&](double fraction, int node) {
        const Vec2 position =
            model.mesh().nodes[lower] + fraction * (model.mesh().nodes[upper] - model.mesh().nodes[lower]);
        return edge_loads.beyond_mouth({{lower, upper}, fraction, position}, node);
      };
      for (const int node : {lower, upper}) {
        const Vec2 at_node = force(1e-28, node), beside = force(1e-9, node);
        CHECK(std::isfinite(at_node.x() + at_node.y()));
        CHECK((at_node - beside).norm() < 1e-6 * 1e6);
      }
    }
  }
}

TEST_CASE("A piece that hangs on one node is called loose") {
  // A corner of two by two cells, cut off along the row above it and the column beside it down to an inner edge beside
  // the node (2, 0) of the boundary: about that node it turns.
  const IntactModel model(plate(1, 1, kCells, kCells), kRock);
  CrackedSolver solver(model, plates::traction_forces(model.mesh(), {0, -1e6, 0.3e6}));
  for (const double gap : {1e-28, 1e-14, 1e-10, 0.02, 0.3}) {
    const auto point = [&](int i, int j, int di, int dj) {
      const int a = j * (kCells + 1) + i;
      const int b = a + dj * (kCells + 1) + di;
      return CrackPoint{{a, b}, gap, model.mesh().nodes[a] + gap * (model.mesh().nodes[b] - model.mesh().nodes[a])};
    };
    Crack crack;
    for (int i = 0; i <= 2; ++i) {
      crack.points.push_back(point(i, 2, 0, 1));
      crack.points.push_back(point(i, 2, 1, 1));
    }
    for (int j = 2; j >= 1; --j) {
      crack.points.push_back(point(2, j, 1, 0));
      crack.points.push_back(point(2, j - 1, 1, 1));
    }
    crack.tips[0] = TipState::at_boundary;
    INFO("gap " << gap);
    REQUIRE(crack_defect(model.mesh(), crack).empty());
    const CrackedState state = solver.solve({&crack, 1});
    CHECK_FALSE(is_separated(model.mesh(), {&crack, 1}, state.enrichment));
    CHECK(state.solved == (gap > 1e-3));
  }
}
