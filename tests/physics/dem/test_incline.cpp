// Oracle: a block on a plane inclined by theta rests while tan(theta) < mu and else slides with
// g (sin(theta) - mu cos(theta)). Gravity is applied as a kick g dt to the block's velocity before each step, which is
// what a body force is in leapfrog; the plane is level and gravity turned.
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

constexpr double kGravity = 9.81;
constexpr double kFriction = 0.5;  // friction angle 26.565 degrees

struct Motion {
  double displacement, velocity, time;
};

/// A block on the plane under gravity that turns from level to `degrees` within `ramp` seconds; without a ramp the
/// shear spring starts at its limit, so that no time is lost in loading it.
Motion slide(double degrees, ContactLaw law, double ramp, double seconds) {
  common::Scene scene;
  scene.effects.friction = true;
  scene.contact.law = law;
  scene.contact.normal_stiffness = 1e8;
  scene.contact.tangential_stiffness = 1e8;
  dem::State state;
  state.friction = kFriction;
  bodies::add(state, bodies::box(20, 1), Vec2(0, -0.5));
  bodies::add(state, bodies::box(0.5, 0.1), Vec2(-2, 0.05));
  state.particles.boundary[0] = 1;
  dem::Engine engine(scene, state);
  const auto& p = engine.state().particles;
  const auto gravity = [&](double time) {
    const double share = time < ramp ? time / ramp : 1;
    const common::SinCos tilt = common::sin_cos(share * degrees * 0.017453292519943295);
    return Vec2(kGravity * tilt.sin, -kGravity * tilt.cos);
  };

  // Pressed in to the depth that carries the weight.
  const double weight = -p.mass[1] * gravity(0).y();
  const double slope = law == ContactLaw::area ? 0.5e8 : law == ContactLaw::mean_depth ? 1e8 : 1e8 * 0.25 / 0.2209;
  engine.edit().particles.position[1].y() -= weight / slope;
  engine.restart();
  if (ramp == 0) engine.edit().contacts[0].shear_displacement = -kFriction * weight / 1e8;
  engine.restart();
  const double start = p.position[1].x();
  while (engine.state().time < seconds) {
    engine.edit().particles.velocity[1] += gravity(engine.state().time) * engine.state().time_step;
    engine.step({});
  }
  return {p.position[1].x() - start, p.velocity[1].x(), engine.state().time};
}

}  // namespace

TEST_CASE("just below the friction angle a block rests on an incline, just above it slides away") {
  for (const ContactLaw law : {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential}) {
    const double early = slide(26.0, law, 0.5, 0.6).displacement;
    const double late = slide(26.0, law, 0.5, 0.8).displacement;
    const double away = slide(27.1, law, 0.5, 0.8).displacement;
    CAPTURE(static_cast<int>(law), early, late, away);
    CHECK(late == Approx(early).margin(1e-6));
    CHECK(std::abs(late) < 2e-5);  // weight sin(theta) / kt = 5e-6 and the rocking of the block
    CHECK(away > 1e-3);
  }
}

TEST_CASE("above the friction angle a block slides with g (sin - mu cos)") {
  for (const ContactLaw law : {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential}) {
    for (const double degrees : {28.0, 35.0, 45.0}) {
      const Motion motion = slide(degrees, law, 0, 0.4);
      const common::SinCos tilt = common::sin_cos(degrees * 0.017453292519943295);
      const double acceleration = kGravity * (tilt.sin - kFriction * tilt.cos);
      CAPTURE(static_cast<int>(law), degrees);
      CHECK(motion.velocity == Approx(acceleration * motion.time).epsilon(0.01));
      CHECK(motion.displacement == Approx(acceleration * motion.time * motion.time / 2).epsilon(0.01));
    }
  }
}
