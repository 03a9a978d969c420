#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "plates.hpp"
#include "xfem/crack/cracked_solver.hpp"
#include "xfem/crack/dense_spd.hpp"

using namespace xfem;
using plates::kRock;
using plates::plate;
using plates::straight_crack;

namespace {

double largest_difference(std::span<const Stress> a, std::span<const Stress> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest =
        std::max({largest, std::abs(a[i].xx - b[i].xx), std::abs(a[i].yy - b[i].yy), std::abs(a[i].xy - b[i].xy)});
  }
  return largest;
}

/// Of the enriched field, summed over the parts of the cut elements [J/m].
double strain_energy(const IntactModel& model, const CrackedState& state) {
  const Eigen::Matrix3d d = kRock.matrix();
  const Mesh& mesh = model.mesh();
  double energy = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const CutElement* cut = nullptr;
    for (const CutElement& element : state.enrichment.cut) {
      if (element.element == static_cast<int>(t)) cut = &element;
    }
    for (std::size_t p = 0; p < (cut != nullptr ? cut->parts.size() : 1); ++p) {
      Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
      for (int k = 0; k < 3; ++k) {
        gradient += state.u.segment<2>(2 * mesh.triangles[t][k]) * model.gradients()[t].gradient[k].transpose();
      }
      if (cut != nullptr) {
        for (const CutElement::Term& term : cut->terms) {
          gradient += state.enrichment.jump(term, cut->parts[p]) * state.q.segment<2>(2 * term.function) *
                      model.gradients()[t].gradient[term.local].transpose();
        }
      }
      const Eigen::Vector3d strain(gradient(0, 0), gradient(1, 1), gradient(0, 1) + gradient(1, 0));
      energy += 0.5 * (cut != nullptr ? cut->parts[p].area : mesh.areas[t]) * strain.dot(d * strain);
    }
  }
  return energy;
}

}  // namespace

TEST_CASE("A crack along the load leaves uniaxial stress undisturbed") {
  const IntactModel model(plate(1, 1, 12, 12, 0.2), kRock);
  int straight = 0;
  for (const double sigma : {1e6, -1e6}) {
    const Stress uniform{0, sigma, 0};
    CrackedSolver solver(model, plates::traction_forces(model.mesh(), uniform));
    for (const double x : {0.401, 0.45, 0.58}) {
      const Crack crack = straight_crack(model.mesh(), {x, 0.2}, {x, 0.8});
      // The points stand off the nodes by the clearance, so the path may kink a little: straight only if none was
      // moved.
      bool is_straight = true;
      for (const CrackPoint& point : crack.points)
        is_straight = is_straight && std::abs(point.position.x() - x) < 1e-12;
      if (!is_straight) continue;
      ++straight;
      const CrackedState state = solver.solve({&crack, 1});
      REQUIRE(state.solved);
      REQUIRE(state.q.size() > 10);
      const std::vector<Stress> expected(state.stress.size(), uniform);
      CHECK(largest_difference(state.stress, expected) < 1e-10 * std::abs(sigma));
    }
  }
  CHECK(straight >= 2);
}

TEST_CASE("The mean element stress is the virial stress, cracked or not, whatever the loads") {
  const IntactModel model(plate(2, 1, 12, 6, 0.3), kRock);
  const Polygon outline{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  common::Random random(17);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Load> loads;
    double size = 0;
    for (int i = 0; i < 5; ++i) {
      const bool horizontal = random.uniform() < 0.5;
      const double side = random.uniform() < 0.5 ? 0 : 1;
      const Vec2 point = horizontal ? Vec2(random.uniform(0, 2), side) : Vec2(2 * side, random.uniform(0, 1));
      loads.push_back({point, {random.uniform(-1e6, 1e6), random.uniform(-1e6, 1e6)}});
      size += loads.back().force.norm();
    }
    std::vector<Crack> cracks{straight_crack(model.mesh(), {0.71, 0}, {0.9, 0.7}, true),
                              straight_crack(model.mesh(), {1.2, 0.2}, {1.7, random.uniform(0.3, 0.9)})};
    cracks[0].tips[1] = TipState::active;
    CrackedSolver solver(model, loads);
    const Stress virial = virial_stress(loads, outline);
    for (const std::size_t count : {0u, 1u, 2u}) {
      const CrackedState state = solver.solve(std::span(cracks).first(count));
      REQUIRE(state.solved);
      const Stress mean = mean_stress(model.mesh(), state.stress);
      CHECK(std::abs(mean.xx - virial.xx) < 1e-12 * size);
      CHECK(std::abs(mean.yy - virial.yy) < 1e-12 * size);
      CHECK(std::abs(mean.xy - virial.xy) < 1e-12 * size);
    }
  }
}

TEST_CASE("A centre crack in a wide plate opens by 4 sigma a / E' in tension") {
  // Plane strain, E' = E / (1 - nu^2); opening at the middle of a crack of length 2 a (Griffith).
  const int cells = 80;
  const IntactModel model(plate(1, 1, cells, cells), kRock);
  const double h = 1.0 / cells;
  const double half_length = 6.0 * h;
  const double sigma = -1e6;
  const Crack crack = straight_crack(model.mesh(), {0.5 - half_length - 0.3 * h, 0.5 + 0.4 * h},
                                     {0.5 + half_length + 0.3 * h, 0.5 + 0.4 * h});
  CrackedSolver solver(model, plates::traction_forces(model.mesh(), {0, sigma, 0}));
  const CrackedState state = solver.solve({&crack, 1});
  REQUIRE(state.solved);
  CHECK(state.closed_segments == 0);
  double largest = 0;
  for (const FaceSegment& face : face_segments(model.mesh(), model.gradients(), state.enrichment)) {
    largest = std::max(largest, opening(face, state.q));
  }
  const double length = (crack.points.back().position - crack.points.front().position).norm();
  const double modulus = kRock.young_modulus / (1 - kRock.poisson_ratio * kRock.poisson_ratio);
  const double theory = 4 * std::abs(sigma) * (length / 2) / modulus;
  INFO("opening over theory " << largest / theory);
  CHECK(largest == Approx(theory).epsilon(0.1));
}

TEST_CASE("A crack across compression closes and carries it as the uncracked plate does") {
  const IntactModel model(plate(1, 1, 20, 20, 0.2), kRock);
  const Stress uniform{0, 1e6, 0};
  CrackedSolver solver(model, plates::traction_forces(model.mesh(), uniform));
  const Crack level = straight_crack(model.mesh(), {0.21, 0.475}, {0.8, 0.475});
  const CrackedState across = solver.solve({&level, 1});
  REQUIRE(across.closed_segments > 10);
  double worst = 0;
  for (const Stress& s : across.stress) worst = std::max(worst, std::abs(s.yy - uniform.yy));
  INFO("largest local deviation " << worst / uniform.yy);
  CHECK(worst < 0.02 * uniform.yy);
  // Under tension the same crack is open and shields the plate.
  CrackedSolver tension(model, plates::traction_forces(model.mesh(), {0, -1e6, 0}));
  const CrackedState open = tension.solve({&level, 1});
  CHECK(open.closed_segments == 0);
  double least = 1;
  for (const Stress& s : open.stress) least = std::min(least, std::abs(s.yy) / 1e6);
  CHECK(least < 0.2);
}

TEST_CASE("Solutions depend on the cracks alone, not on what was solved before") {
  const IntactModel model(plate(1, 1, 10, 10, 0.2), kRock);
  const Eigen::VectorXd forces = plates::traction_forces(model.mesh(), {0.3e6, -1e6, 0.2e6});
  const Crack whole = straight_crack(model.mesh(), {0.15, 0.44}, {0.85, 0.58});
  CrackedSolver growing(model, forces);
  for (std::size_t points = 2; points <= whole.points.size(); ++points) {
    Crack crack = whole;
    crack.points.resize(points);
    const CrackedState grown = growing.solve({&crack, 1});
    CrackedSolver fresh(model, forces);
    const CrackedState alone = fresh.solve({&crack, 1});
    CHECK(grown.u == alone.u);
    CHECK(grown.q == alone.q);
  }
}

TEST_CASE("The bordered solution fulfils the equations of the whole enriched system") {
  // Oracle: the strain energy of the enriched field, summed over the parts, equals half the work of the loads.
  const IntactModel model(plate(1, 1, 10, 10, 0.2), kRock);
  const Eigen::VectorXd forces = plates::traction_forces(model.mesh(), {0, -1e6, 0});
  const Crack crack = straight_crack(model.mesh(), {0.15, 0.44}, {0.85, 0.58});
  CrackedSolver solver(model, forces);
  const CrackedState state = solver.solve({&crack, 1});
  REQUIRE(state.closed_segments == 0);
  CHECK(strain_energy(model, state) == Approx(0.5 * forces.dot(state.u)).epsilon(1e-10));
}

TEST_CASE("The faces of a ragged sliding crack are in equilibrium") {
  // Kinks that ride up on one another make the set of pressing segments hard to find. Oracle: the work of the loads is
  // twice the energy of the strain and of the segments that overlap in the solution, which holds for the right set.
  int closed = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const IntactModel model(plate(1, 1, 16, 16, 0.3), kRock);
    common::Random random(100 + trial);
    std::vector<Vec2> line;
    for (int i = 0; i <= 12; ++i) {
      line.push_back({0.4 + 0.015 * i + 0.03 * random.uniform(-1, 1), 0.15 + 0.058 * i});
    }
    const Crack crack = place_polyline(model.mesh(), line, {TipState::active, TipState::active});
    REQUIRE(crack.points.size() > 10);
    const Eigen::VectorXd forces = plates::traction_forces(model.mesh(), {0.05e6, 1e6, 0});
    CrackedSolver solver(model, forces);
    const CrackedState state = solver.solve({&crack, 1});
    REQUIRE(state.solved);
    double contact = 0;
    for (const FaceSegment& face : face_segments(model.mesh(), model.gradients(), state.enrichment)) {
      const double overlap = std::min(0.0, opening(face, state.q));
      contact += 0.5 * kFacePenalty * kRock.young_modulus / model.mesh().size * face.length * overlap * overlap;
    }
    CHECK(strain_energy(model, state) + contact == Approx(0.5 * forces.dot(state.u)).epsilon(1e-10));
    closed += state.closed_segments;
  }
  CHECK(closed > 20);
}

TEST_CASE("A crack as near to a node as it may be is solved as well as one further off") {
  const IntactModel model(plate(1, 1, 10, 10), kRock);
  CrackedSolver solver(model, plates::traction_forces(model.mesh(), {0, -1e6, 0}));
  const auto opening_at = [&](double y) {
    const Crack crack = straight_crack(model.mesh(), {0.21, y}, {0.79, y});
    const CrackedState state = solver.solve({&crack, 1});
    REQUIRE(state.solved);
    const Stress mean = mean_stress(model.mesh(), state.stress);
    CHECK(std::abs(mean.yy + 1e6) < 1e-6);
    double largest = 0;
    for (const FaceSegment& face : face_segments(model.mesh(), model.gradients(), state.enrichment)) {
      largest = std::max(largest, opening(face, state.q));
    }
    return largest;
  };
  const double middle = opening_at(0.55);
  for (const double y : {0.5 + 1e-9, 0.502, 0.51, 0.59, 0.6 - 1e-9})
    CHECK(opening_at(y) == Approx(middle).epsilon(0.3));
}

TEST_CASE("Scaling the diagonal keeps a system well conditioned over 28 decades") {
  common::Random random(23);
  const int n = 12;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) a(i, j) = random.uniform(-1, 1);
  }
  const Eigen::MatrixXd spd = a * a.transpose() + 0.5 * Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd x(n), scale(n);
  for (int i = 0; i < n; ++i) {
    scale[i] = std::pow(10.0, -28.0 * i / (n - 1) / 2);
    x[i] = random.uniform(-1, 1);
  }
  DenseSymmetric matrix(n);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) matrix.at(i, j) = scale[i] * spd(i, j) * scale[j];
  }
  const auto found = solve_spd(matrix, scale.cwiseProduct(spd * x));
  REQUIRE(found);
  for (int i = 0; i < n; ++i) CHECK((*found)[i] * scale[i] == Approx(x[i]).epsilon(1e-11));
  matrix.at(3, 3) = 0;
  CHECK_FALSE(solve_spd(matrix, x));
}

TEST_CASE("The condition of a scaled system is told: exact for two unknowns, Hager's bound for more") {
  for (const double a : {0.0, 0.5, -0.9, 0.999999}) {
    DenseSymmetric matrix(2);  // diagonal 4 and 1e-20 before scaling
    matrix.at(0, 0) = 4;
    matrix.at(1, 1) = 1e-20;
    matrix.at(0, 1) = a * 2e-10;
    const SpdCondition found = condition_of(matrix);
    CHECK(found.condition == Approx((1 + std::abs(a)) / (1 - std::abs(a))).epsilon(1e-8));
    CHECK(found.smallest_pivot == Approx(1 - a * a).epsilon(1e-8));
  }
  const int n = 12;
  Eigen::MatrixXd spd(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) spd(i, j) = 1.0 / (i + j + 1) + (i == j ? 1e-6 : 0.0);  // nearly Hilbert's matrix
  }
  DenseSymmetric matrix(n);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j) matrix.at(i, j) = spd(i, j);
  }
  const Eigen::VectorXd scale = spd.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * spd * scale.asDiagonal();
  const auto norm = [](const Eigen::MatrixXd& m) { return m.cwiseAbs().colwise().sum().maxCoeff(); };
  const double exact = norm(scaled) * norm(scaled.inverse());
  const SpdCondition found = condition_of(matrix);
  CHECK(found.condition <= 1.001 * exact);
  CHECK(found.condition >= exact / 3);
  CHECK(found.condition >= 1 / found.smallest_pivot);

  DenseSymmetric singular(2);
  singular.at(0, 0) = singular.at(1, 1) = singular.at(0, 1) = 1;
  CHECK(std::isinf(condition_of(singular).condition));
  CHECK(condition_of(singular).row == 1);
}
