#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "tests/unit/xfem/crack/plates.hpp"
#include "xfem/crack/given_crack.hpp"
#include "xfem/crack/toughness.hpp"

using namespace xfem;

namespace {

const Polygon kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

/// K of one tip of a crack in a plate under uniform stress (compression positive).
StressIntensity intensity_of(const Mesh& mesh, const Crack& crack, const Stress& stress, int end) {
  const IntactModel model(mesh, plates::kRock);
  CrackedSolver solver(model, plates::traction_forces(mesh, stress));
  const std::vector<Crack> cracks{crack};
  const std::optional<StressIntensity> found = stress_intensity(model, solver.solve(cracks), cracks, 0, end);
  REQUIRE(found);
  return *found;
}

}  // namespace

TEST_CASE("The largest hoop stress stands ahead of an opening tip and at 70.5 degrees of a sliding one") {
  const TipDrive opens = largest_hoop_stress({2, 0, {0, 1}});
  CHECK(opens.equivalent == Approx(2));
  CHECK((opens.direction - Vec2(0, 1)).norm() < 1e-14);
  const double angle = std::acos(1.0 / 3);
  for (const int sign : {1, -1}) {
    const TipDrive slides = largest_hoop_stress({-3, 2.0 * sign, {1, 0}});
    CHECK(slides.equivalent == Approx(2 * 2 / std::sqrt(3)).epsilon(1e-12));
    CHECK((slides.direction - Vec2(std::cos(angle), -sign * std::sin(angle))).norm() < 1e-12);
  }
  // Of K_eq over all angles the direction found is the largest (Erdogan & Sih 1963, Eq. 5).
  const StressIntensity mixed{1.3, 0.7, {1, 0}};
  const TipDrive found = largest_hoop_stress(mixed);
  for (double t = -3; t < 3; t += 0.01) {
    const double hoop = std::cos(t / 2) * (mixed.one * std::pow(std::cos(t / 2), 2) - 1.5 * mixed.two * std::sin(t));
    CHECK(hoop <= found.equivalent * (1 + 1e-12));
  }
  CHECK(largest_hoop_stress({0, 0, {1, 0}}).equivalent == 0);
}

TEST_CASE("Both tips of a crack have the same stress intensity, whichever way the crack is stored") {
  const Mesh mesh = make_mesh(kSquare, 600);
  Crack crack = plates::straight_crack(mesh, {0.3, 0.42}, {0.7, 0.58});
  const Stress pull{-1e5, -1e6, 3e5};
  const StressIntensity first = intensity_of(mesh, crack, pull, 0), last = intensity_of(mesh, crack, pull, 1);
  CHECK(first.one == Approx(last.one).epsilon(0.04));
  CHECK(first.two == Approx(last.two).margin(0.04 * last.one));
  std::reverse(crack.points.begin(), crack.points.end());
  const StressIntensity turned = intensity_of(mesh, crack, pull, 1);
  CHECK(turned.one == Approx(first.one).epsilon(1e-9));
  CHECK(turned.two == Approx(first.two).epsilon(1e-9));
}

TEST_CASE("Stress intensity is linear in the load and does not depend on the elastic modulus") {
  const Mesh mesh = make_mesh(kSquare, 400);
  const Crack crack = plates::straight_crack(mesh, {0.3, 0.4}, {0.7, 0.6});
  const StressIntensity once = intensity_of(mesh, crack, {0, -1e6, 0}, 1);
  const StressIntensity twice = intensity_of(mesh, crack, {0, -2e6, 0}, 1);
  CHECK(twice.one == Approx(2 * once.one).epsilon(1e-10));
  CHECK(twice.two == Approx(2 * once.two).epsilon(1e-10));
  const IntactModel soft(mesh, {1, 0.2, false});
  CrackedSolver solver(soft, plates::traction_forces(mesh, {0, -1e6, 0}));
  const std::vector<Crack> cracks{crack};
  CHECK(stress_intensity(soft, solver.solve(cracks), cracks, 0, 1)->one == Approx(once.one).epsilon(1e-9));
}

TEST_CASE("A crack along or across compression has no stress intensity") {
  const Mesh mesh = make_mesh(kSquare, 600);
  const double scale = 1e6 * std::sqrt(std::numbers::pi * 0.2);  // of the same crack under the same pull
  for (const Stress& push : {Stress{0, 1e6, 0}, Stress{1e6, 1e6, 0}}) {
    const Crack across = plates::straight_crack(mesh, {0.3, 0.5}, {0.7, 0.5});
    const StressIntensity closed = intensity_of(mesh, across, push, 1);
    CHECK(closed.one == 0);
    CHECK(std::abs(closed.two) < 0.03 * scale);
  }
  const StressIntensity along =
      intensity_of(mesh, plates::straight_crack(mesh, {0.3, 0.5}, {0.7, 0.5}), {1e6, 0, 0}, 1);
  CHECK(std::abs(along.one) + std::abs(along.two) < 0.03 * scale);
}

TEST_CASE("Where no ring is left around a tip it has no stress intensity") {
  const Mesh mesh = make_mesh(kSquare, 200);
  const IntactModel model(mesh, plates::kRock);
  CrackedSolver solver(model, plates::traction_forces(mesh, {0, -1e6, 0}));
  for (const double end : {0.3, 0.97}) {
    const std::vector<Crack> cracks{plates::straight_crack(mesh, {0.2, 0.5}, {end, 0.5})};
    const int tip = end > 0.5 ? 1 : 0;
    CHECK_FALSE(stress_intensity(model, solver.solve(cracks), cracks, 0, tip));
  }
}

TEST_CASE("A given crack acts from end to end, as nearly as elements allow") {
  for (const int nodes : {150, 600}) {
    const Mesh mesh = make_mesh(kSquare, nodes);
    for (const double angle : {0.0, 0.3, 1.1}) {
      const Vec2 along(std::cos(angle), std::sin(angle));
      const Vec2 from = Vec2(0.5, 0.5) - 0.25 * along, to = Vec2(0.5, 0.5) + 0.25 * along;
      const Crack crack = place_given_crack(mesh, kSquare, from, to);
      CHECK(crack_defect(mesh, crack).empty());
      CHECK(crack.tips == std::array{TipState::active, TipState::active});
      const Vec2& first = crack.points.front().position;
      const Vec2& last = crack.points.back().position;
      CHECK((first - from).dot(-along) == Approx(kTipShift * mesh.size).margin(0.3 * mesh.size));
      CHECK((last - to).dot(along) == Approx(kTipShift * mesh.size).margin(0.3 * mesh.size));
      CHECK(std::abs(common::cross(along, first - from)) < 0.35 * mesh.size);
    }
    const Crack edge = place_given_crack(mesh, kSquare, {-0.01, 0.4}, {0.3, 0.4});
    CHECK(edge.tips == std::array{TipState::at_boundary, TipState::active});
    CHECK(edge.points.front().position.x() == 0);
  }
  const Mesh coarse = make_mesh(kSquare, 60);
  CHECK_THROWS_WITH(place_given_crack(coarse, kSquare, {0.48, 0.5}, {0.52, 0.5}), Catch::Contains("fewer than three"));
}
