// Oracle: the damped oscillator, released where its force would begin to pull (Schwager & Poeschel 2007, Granular
// Matter 9, 465-469): restitution e = exp(-beta / s (pi - atan(2 beta s / (1 - 2 beta^2)))), s = sqrt(1 - beta^2), for
// beta < 1/sqrt(2). Face contacts are linear for every law.
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

double restitution(double beta) {
  const double s = std::sqrt(1 - beta * beta);
  return std::exp(-beta / s * (3.141592653589793 - std::atan(2 * beta * s / (1 - 2 * beta * beta))));
}

common::Scene scene_of(ContactLaw law, double beta) {
  common::Scene scene;
  scene.contact.law = law;
  scene.contact.normal_stiffness = 1e9;
  scene.effects.contact_damping = true;
  scene.effects.energy_ledger = true;
  scene.damping.contact = beta;
  scene.time_step.safety = 0.001;
  return scene;
}

/// Two boxes that meet with whole faces; the lower one is fixed, or as free as the other.
dem::Engine approach(const common::Scene& scene, bool fixed, double friction, const Vec2& velocity) {
  dem::State state;
  state.friction = friction;
  bodies::add(state, bodies::box(0.5, 0.4), Vec2(0, -0.2));
  bodies::add(state, bodies::box(0.5, 0.2), Vec2(0, 0.1 + 1e-9));
  state.particles.boundary[0] = fixed;
  state.particles.velocity[1] = velocity;
  return {scene, state};
}

}  // namespace

TEST_CASE("contact damping gives the restitution of a dashpot that never pulls") {
  for (const ContactLaw law : kLaws) {
    for (const double beta : {0.05, 0.2, 0.5}) {
      for (const bool fixed : {true, false}) {
        dem::Engine engine = approach(scene_of(law, beta), fixed, 0, Vec2(0, -0.1));
        const auto& p = engine.clock().particles;
        const double before = engine.kinetic_energy();
        double pull = 0;
        for (bool touched = false;;) {
          engine.step({});
          for (const dem::Contact& c : engine.state().contacts) pull = std::max(pull, -c.normal_force);
          if (touched && engine.contacts() == 0) break;
          touched |= engine.contacts() > 0;
          if (engine.clock().time > 1) FAIL("the bodies do not part");
        }
        const double e = (p.velocity[1].y() - p.velocity[0].y()) / 0.1;
        const double lost = before - engine.kinetic_energy();
        CAPTURE(static_cast<int>(law), beta, fixed, e / restitution(beta) - 1);
        CHECK(e == Approx(restitution(beta)).epsilon(3e-4));
        CHECK(pull == 0);
        CHECK(engine.clock().energy.contact_damping == Approx(lost).epsilon(2e-6));
        const Vec2 momentum = p.mass[0] * p.velocity[0] + p.mass[1] * p.velocity[1];
        if (!fixed) CHECK(momentum.y() == Approx(p.mass[1] * -0.1).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("with contact damping Coulomb's limit is that of the total normal force") {
  common::Scene scene = scene_of(ContactLaw::mean_depth, 0.5);
  scene.effects.friction = true;
  dem::Engine engine = approach(scene, true, 0.3, Vec2(5, -0.1));
  double excess = 0;
  int sliding = 0;
  for (int k = 0; k < 20000; ++k) {
    engine.step({});
    for (const dem::Contact& c : engine.state().contacts) {
      excess = std::max(excess, std::abs(c.shear_force) - 0.3 * c.normal_force * (1 + 1e-14));
      sliding += std::abs(c.shear_force) > 0.299 * c.normal_force;
    }
  }
  CHECK(sliding > 1000);
  CHECK(excess <= 0);
}
