// Oracle: a block on a plane inclined by theta rests while tan(theta) < mu and else slides with
// g (sin(theta) - mu cos(theta)). The plane is level and gravity inclined.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

constexpr ContactLaw kLaws[] = {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential,
                                ContactLaw::foundation};
constexpr double kGravity = 9.81;
constexpr double kFriction = 0.5;  // friction angle 26.565 degrees
constexpr double kSize = 0.5;

/// A block on the plane, pressed in to the depth that carries its weight.
dem::Engine block_on_plane(common::Scene& scene, double degrees) {
  scene.effects.friction = true;
  scene.effects.gravity = true;
  scene.contact.normal_stiffness = scene.contact.tangential_stiffness.emplace(1e8);
  const common::SinCos tilt = common::sin_cos(degrees * 0.017453292519943295);
  scene.gravity.acceleration = kGravity * Vec2(tilt.sin, -tilt.cos);
  dem::State state;
  state.friction = kFriction;
  bodies::add(state, bodies::box(8, 1), Vec2(3, -0.5));
  bodies::add(state, bodies::box(kSize, 0.1), Vec2(0, 0.05));
  auto& p = state.particles;
  p.boundary[0] = 1;
  const ContactLaw law = scene.contact.law;
  const double slope = common::stiffness_is_per_area(law) ? 0.5e8
                       : law == ContactLaw::mean_depth    ? 1e8
                                                          : 1e8 * 0.25 / 0.2209;
  p.position[1].y() -= p.mass[1] * kGravity * tilt.cos / slope;
  return {scene, state};
}

}  // namespace

TEST_CASE("just below the friction angle a block rests on an incline: no creep in 10^5 steps") {
  for (const ContactLaw law : kLaws) {
    for (const double degrees : {10.0, 26.0, 26.5}) {
      common::Scene scene;
      scene.contact.law = law;
      scene.effects.local_damping = true;
      dem::Engine engine = block_on_plane(scene, degrees);
      const double start = engine.state().particles.position[1].x();
      for (int k = 0; k < 40000; ++k) engine.step({});
      const Vec2 settled = engine.clock().particles.position[1];
      const double turned = engine.clock().particles.angle[1];
      double creep = 0, turn = 0;
      for (int k = 0; k < 100000; ++k) {
        engine.step({});
        creep = std::max(creep, (engine.clock().particles.position[1] - settled).norm());
        turn = std::max(turn, std::abs(engine.clock().particles.angle[1] - turned));
      }
      CAPTURE(static_cast<int>(law), degrees, creep / kSize, turn, settled.x() - start);
      CHECK(creep < 1e-12 * kSize);
      CHECK(turn < 1e-12);
      CHECK(settled.x() - start < 1e-3);  // the spring takes weight sin(theta) / kt = 5e-6, settling the rest
    }
  }
}

TEST_CASE("above the friction angle a block slides with g (sin - mu cos)") {
  for (const ContactLaw law : kLaws) {
    for (const double degrees : {27.0, 35.0, 45.0}) {
      common::Scene scene;
      scene.contact.law = law;
      scene.effects.contact_damping = true;  // stills the bouncing, and leaves the sliding alone
      scene.damping.contact = 0.5;
      dem::Engine engine = block_on_plane(scene, degrees);
      // The moment of friction rocks the block, whose weight the plane then carries on the average only: what its
      // normal force does beyond g cos(theta) is seen in its normal velocity.
      while (engine.clock().time < 0.1) engine.step({});
      const Vec2 before = engine.clock().particles.velocity[1];
      const double begin = engine.clock().time;
      while (engine.clock().time < 0.6) engine.step({});
      const Vec2 gained = engine.clock().particles.velocity[1] - before;
      const double time = engine.clock().time - begin;
      const common::SinCos tilt = common::sin_cos(degrees * 0.017453292519943295);
      const double theory = kGravity * (tilt.sin - kFriction * tilt.cos);
      CAPTURE(static_cast<int>(law), degrees, gained.x() / time / theory - 1);
      CHECK(gained.x() / time == Approx(theory).margin(1e-3 * kGravity));
      CHECK((gained.x() + kFriction * gained.y()) / time == Approx(theory).epsilon(1e-9));
    }
  }
}
