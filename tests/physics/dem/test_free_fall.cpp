// Oracle: the parabola that the leapfrog gives exactly, v_n = v_0 + n g dt and x_n = x_0 + n v_0 dt + n (n + 1)/2 g
// dt^2.
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::Vec2;

namespace {

constexpr int kSteps = 20000;
const Vec2 kGravity(0.5, -9.81);

dem::State bodies_apart() {
  dem::State state;
  bodies::add(state, bodies::box(0.5, 0.3), Vec2(0, 0), 0.2);
  bodies::add(state, bodies::hexagon(0.01), Vec2(2, 1));
  bodies::add(state, bodies::box(0.4, 0.4), Vec2(-2, -1));
  bodies::add(state, bodies::box(1, 1), Vec2(0, -900));
  auto& p = state.particles;
  p.velocity = {Vec2(1, 3), Vec2(-0.5, 0), Vec2(0, 2), Vec2(0, 0)};
  p.angular_velocity = {2, -1, 0, 0};
  p.boundary[3] = 1;
  return state;
}

common::Scene scene_with_gravity() {
  common::Scene scene;
  scene.effects.gravity = true;
  scene.effects.energy_ledger = true;
  scene.gravity.acceleration = kGravity;
  return scene;
}

}  // namespace

TEST_CASE("in free fall every body follows the leapfrog's parabola, whatever its mass, and its spin stays") {
  const dem::State start = bodies_apart();
  dem::Engine engine(scene_with_gravity(), start);
  const double energy = engine.kinetic_energy();
  for (int n = 0; n < kSteps; ++n) engine.step({});
  const auto& p = engine.state().particles;
  const double dt = engine.state().time_step;
  const double n = kSteps;
  const double rounding = n * 2.3e-16;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 v0 = start.particles.velocity[i];
    const Vec2 velocity = v0 + n * dt * kGravity;
    const Vec2 fall = n * dt * v0 + n * (n + 1) / 2 * dt * dt * kGravity;
    CAPTURE(i, fall.y());
    CHECK((p.velocity[i] - velocity).norm() < rounding * velocity.norm());
    CHECK((p.position[i] - start.particles.position[i] - fall).norm() < rounding * (1 + fall.norm()));
    CHECK(p.displacement[i].isApprox(fall, 1e-11));
    CHECK(p.angular_velocity[i] == start.particles.angular_velocity[i]);
  }
  // The driven block neither falls nor weighs.
  CHECK(p.position[3] == start.particles.position[3]);
  CHECK(engine.forces().force[3] == Vec2(0, 0));
  const double work = engine.state().energy.gravity_work;
  CHECK(work == Approx(engine.kinetic_energy() - energy).epsilon(1e-11));
  CHECK(engine.state().energy.boundary_work == 0);
}

TEST_CASE("without the effect nothing falls") {
  common::Scene scene = scene_with_gravity();
  scene.effects.gravity = false;
  const dem::State start = bodies_apart();
  dem::Engine engine(scene, start);
  for (int n = 0; n < 100; ++n) engine.step({});
  CHECK(engine.state().particles.velocity == start.particles.velocity);
  CHECK(engine.state().energy.gravity_work == 0);
}

TEST_CASE("a particle whose mass is scaled falls with its true weight over its raised mass") {
  common::Scene scene = scene_with_gravity();
  scene.effects.mass_scaling = true;
  scene.mass_scaling.smallest_mass = 0.3;
  const dem::State start = bodies_apart();
  dem::Engine engine(scene, start);
  const auto& m = start.particles.mass;
  const double least = 0.3 * (m[0] + m[1] + m[2] + m[3]) / 4;
  REQUIRE(m[1] < least);
  REQUIRE(m[0] > least);
  CHECK(engine.least_mass() == Approx(least).epsilon(1e-15));
  const double energy = engine.kinetic_energy();
  for (int n = 0; n < 1000; ++n) engine.step({});
  const auto& p = engine.state().particles;
  const double time = 1000 * engine.state().time_step;
  CHECK((p.velocity[0] - start.particles.velocity[0] - time * kGravity).norm() < 1e-12);
  CHECK((p.velocity[1] - start.particles.velocity[1] - time * (m[1] / least) * kGravity).norm() < 1e-12);
  CHECK(p.mass == start.particles.mass);
  CHECK(engine.state().energy.gravity_work == Approx(engine.kinetic_energy() - energy).epsilon(1e-11));
}

TEST_CASE("with mass scaling the smallest particles do not set the time step") {
  common::Scene scene = scene_with_gravity();
  dem::Engine plain(scene, bodies_apart());
  scene.effects.mass_scaling = true;
  scene.mass_scaling.smallest_mass = 0.3;
  dem::Engine scaled(scene, bodies_apart());
  const double smallest = bodies_apart().particles.mass[1];
  CHECK(scaled.state().time_step / plain.state().time_step ==
        Approx(std::sqrt(scaled.least_mass() / smallest)).epsilon(1e-14));
}
