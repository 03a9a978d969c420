// Oracle: statics. A block that stands on a corner under gravity is held by a rolling moment of at most mu_r R N, so it
// stays while its centroid is less than mu_r R beside the corner, and falls beyond.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/effects/rolling_resistance.hpp"
#include "dem/engine.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

constexpr double kSide = 0.4;
constexpr double kGravity = 9.81;
constexpr double kRolling = 0.1;

common::Scene scene_of() {
  common::Scene scene;
  scene.contact.law = ContactLaw::mean_depth;
  scene.contact.normal_stiffness = 1e10;
  scene.contact.rolling_friction = kRolling;
  scene.effects.friction = true;
  scene.effects.local_damping = true;
  scene.effects.rolling_resistance = true;
  scene.effects.gravity = true;
  scene.effects.energy_ledger = true;
  return scene;
}

/// R of the standing block on the fixed one.
double radius() {
  return dem::rolling_radius(4, kSide * kSide);
}

/// A square on its lower corner, its centroid `offset` to the right of it, in equilibrium but for that offset.
dem::Engine on_corner(const common::Scene& scene, double offset) {
  dem::State state;
  state.friction = 0.5;
  bodies::add(state, bodies::box(4, 1), Vec2(0, -0.5));
  const double half = kSide * 0.70710678118654752;
  const double lean = std::asin(offset / half);
  bodies::add(state, bodies::box(kSide, kSide), Vec2(0, 0), -0.7853981633974483 - lean);
  auto& p = state.particles;
  p.boundary[0] = 1;
  const double weight = p.mass[1] * kGravity;
  const double depth = 2 * weight / scene.contact.normal_stiffness;  // of a corner the mean depth is half of this
  p.position[1] = Vec2(offset, half * std::cos(lean) - depth);
  dem::Engine engine(scene, state);
  REQUIRE(engine.state().contacts.size() == 1);
  if (scene.effects.rolling_resistance) engine.edit().contacts[0].rolling_moment = weight * offset;
  engine.restart();
  return engine;
}

}  // namespace

TEST_CASE("a block stands on its corner while the centroid is less than mu_r R beside it, and falls beyond") {
  const common::Scene scene = scene_of();
  for (const double side : {1.0, -1.0}) {
    dem::Engine standing = on_corner(scene, side * 0.99 * kRolling * radius());
    const double lean = standing.state().particles.angle[1];
    for (int k = 0; k < 40000; ++k) standing.step({});
    const double settled = standing.state().particles.angle[1];
    for (int k = 0; k < 20000; ++k) standing.step({});
    const auto& p = standing.state().particles;
    const dem::Contact& c = standing.state().contacts.at(0);
    const double weight = p.mass[1] * kGravity;
    CAPTURE(side, settled - lean, p.angle[1] - settled);
    CHECK(std::abs(settled - lean) < 1e-3);
    CHECK(std::abs(p.angle[1] - settled) < 1e-12);
    CHECK(c.normal_force == Approx(weight).epsilon(1e-9));
    CHECK(c.rolling_moment == Approx(weight * (p.position[1].x() - c.point.x())).epsilon(1e-9));

    dem::Engine falling = on_corner(scene, side * 1.01 * kRolling * radius());
    const double start = falling.state().particles.angle[1];
    for (int k = 0; k < 60000; ++k) falling.step({});
    CHECK(side * (start - falling.state().particles.angle[1]) > 0.01);
  }
}

TEST_CASE("without rolling resistance a block does not stand on its corner") {
  common::Scene scene = scene_of();
  scene.effects.rolling_resistance = false;
  dem::Engine engine = on_corner(scene, 0.1 * kRolling * radius());
  const double start = engine.state().particles.angle[1];
  for (int k = 0; k < 60000; ++k) engine.step({});
  CHECK(start - engine.state().particles.angle[1] > 0.01);
}

TEST_CASE("a rolling moment is a spring up to its limit, and what it dissipates is the work beyond") {
  // Two boxes face to face, turned against each other by a given spin.
  constexpr double kStiffness = 7;
  double moment = 0, work = 0;
  for (int k = 0; k < 300; ++k) {
    const double turn = k < 100 ? 0.01 : -0.01;
    const double before = moment;
    moment = dem::rolling_moment(moment, turn, kStiffness, 3);
    work -= 0.5 * (before + moment) * turn;
    if (k < 42) CHECK(moment == Approx(-kStiffness * 0.01 * (k + 1)).epsilon(1e-12));
  }
  CHECK(moment == 3);
  // Loaded to the limit (0.4286 rad), slipped to 1 rad, unloaded and loaded the other way (0.857 rad), slipped to -1.
  const double slip = (1 - 3 / 7.0) + (2 - 6 / 7.0);
  CHECK(work - moment * moment / (2 * kStiffness) == Approx(3 * slip).epsilon(1e-2));
}
