// Friction on closed crack faces: a state that meets Coulomb's law on every face is found whatever the faces look like.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/robustness/xfem/full_system.hpp"
#include "tests/unit/xfem/crack/plates.hpp"
#include "xfem/crack/friction_path.hpp"

using namespace xfem;

namespace {

/// Uniform pressures on the sides of the unit square and a shear, as point forces.
std::vector<Load> boundary_loads(double across, double along, double shear) {
  std::vector<Load> loads;
  for (int i = 0; i < 8; ++i) {
    const double s = (i + 0.5) / 8;
    loads.push_back({{s, 0}, Vec2(shear, along) / 8});
    loads.push_back({{s, 1}, -Vec2(shear, along) / 8});
    loads.push_back({{0, s}, Vec2(across, shear) / 8});
    loads.push_back({{1, s}, -Vec2(across, shear) / 8});
  }
  return loads;
}

Crack ragged(const Mesh& mesh, common::Random& random, const Vec2& from, const Vec2& to, double height) {
  std::vector<Vec2> line;
  for (int i = 0; i <= 12; ++i) {
    const Vec2 off = height * Vec2(random.uniform(-1, 1), random.uniform(-0.3, 0.3));
    line.push_back(from + (i / 12.0) * (to - from) + off);
  }
  return place_polyline(mesh, line, {TipState::active, TipState::active});
}

/// Random faces on a random stiffness: what a crack could at worst look like.
struct System {
  System(common::Random& random, int functions, int count) : schur(2 * functions), right(2 * functions) {
    const int n = schur.size;
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return random.uniform(-1, 1); });
    const Eigen::MatrixXd full = half * half.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
    for (int i = 0; i < n; ++i) {
      right[i] = random.uniform(-1, 1);
      for (int j = i; j < n; ++j) schur.at(i, j) = full(i, j);
    }
    for (int k = 0; k < count; ++k) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      FaceSegment face{k, random.uniform(0.5, 1), Vec2(x, y).normalized(), {}};
      for (int f = 0; f < functions; ++f) {
        if (random.uniform() < 0.5) face.jumps.emplace_back(f, random.uniform(0.2, 2));
      }
      if (!face.jumps.empty()) faces.push_back(face);
    }
  }
  DenseSymmetric schur;
  Eigen::VectorXd right;
  std::vector<FaceSegment> faces;
};

}  // namespace

TEST_CASE("Friction on the faces of ragged cracks always settles in a state that meets Coulomb's law") {
  int closed = 0, sliding = 0;
  double worst = 0, worst_residual = 0;
  const common::Polygon outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int trial = 0; trial < 150; ++trial) {
    common::Random random(1000 + trial);
    const IntactModel model(plates::plate(1, 1, 12, 12, trial % 3 == 0 ? 0.0 : 0.3), plates::kRock);
    const double height = random.uniform(0, 0.06);
    const double tilt = random.uniform(-0.25, 0.25);
    std::vector<Crack> cracks{ragged(model.mesh(), random, {0.5 - tilt, 0.15}, {0.5 + tilt, 0.85}, height)};
    if (random.uniform() < 0.5) {
      const double y = random.uniform(0.1, 0.9);
      cracks.push_back(ragged(model.mesh(), random, {0.05, y}, {0.2, y}, height));
    }
    std::erase_if(cracks, [&](const Crack& crack) {
      return crack.points.size() < 4 || !crack_defect(model.mesh(), crack).empty();
    });
    const std::vector<Load> loads =
        boundary_loads(random.uniform(-0.3e6, 1e6), random.uniform(-0.3e6, 1e6), random.uniform(-1e6, 1e6));
    for (const double friction : {0.6, 1.0, 2.0}) {
      INFO("trial " << trial << ", friction " << friction);
      const CrackedState state = CrackedSolver(model, loads, 0, friction).solve(cracks);
      REQUIRE(state.solved);
      REQUIRE(state.settled);
      const double penalty = kFacePenalty * plates::kRock.young_modulus / model.mesh().size;
      const std::vector<FaceSegment> faces = face_segments(model.mesh(), model.gradients(), state.enrichment);
      double error = 0, largest = 0;
      for (std::size_t i = 0; i < faces.size(); ++i) {
        const double bound = friction * penalty * std::max(0.0, -opening(faces[i], state.q));
        const double shear = std::clamp(penalty * slip(faces[i], state.q), -bound, bound);
        error = std::max(error, std::abs(state.face_shear[i] - shear));
        largest = std::max(largest, bound);
        sliding += bound > 0 && std::abs(shear) == bound;
      }
      closed += state.closed_segments;
      worst = std::max(worst, largest > 0 ? error / largest : 0.0);
      worst_residual = std::max(worst_residual, growth_walks::residual_of(model, loads, 0, outline, state).scaled);
    }
  }
  CHECK(closed > 1000);
  CHECK(sliding > 300);
  CHECK(worst < 2e-9);  // of the largest bound: the iteration ends at 1e-9
  CHECK(worst_residual < 1e-12);
}

TEST_CASE("The friction path ends in equilibrium under Coulomb's law on systems that no crack would make") {
  common::Random random(5);
  int ended = 0, trials = 0, most_pieces = 0;
  double worst = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const System system(random, 3 + static_cast<int>(random.index(8)), 2 + static_cast<int>(random.index(10)));
    const double penalty = 100, friction = random.uniform(0.1, 4);
    ++trials;
    const auto path = follow_friction_path(system.schur, system.right, system.faces, penalty, friction);
    if (!path) continue;
    ++ended;
    most_pieces = std::max(most_pieces, path->pieces);
    Eigen::VectorXd rest = -system.right;
    for (int i = 0; i < system.schur.size; ++i) {
      for (int j = 0; j < system.schur.size; ++j) {
        rest[i] += system.schur.at(std::min(i, j), std::max(i, j)) * path->q[j];
      }
    }
    double scale = system.right.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < system.faces.size(); ++i) {
      const FaceSegment& face = system.faces[i];
      const double pressure = penalty * std::max(0.0, -opening(face, path->q));
      const double shear = std::clamp(penalty * slip(face, path->q), -friction * pressure, friction * pressure);
      scale = std::max({scale, pressure, std::abs(shear)});
      for (const auto& [function, weight] : face.jumps) {
        rest.segment<2>(2 * function) += face.length * weight * (shear * Vec2(face.normal.y(), -face.normal.x()));
        rest.segment<2>(2 * function) -= face.length * weight * (pressure * face.normal);
      }
    }
    worst = std::max(worst, rest.cwiseAbs().maxCoeff() / scale);
  }
  INFO(ended << " of " << trials << ", at most " << most_pieces << " pieces");
  CHECK(ended == trials);
  CHECK(worst < 1e-8);
  CHECK(most_pieces > 20);
}
