// Oracles: the first law for a pile with every effect on; the limits of Coulomb and of rolling; the run that was not
// interrupted.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/checkpoint.hpp"
#include "dem/effects/rolling_resistance.hpp"
#include "dem/engine.hpp"
#include "dem/stages/control.hpp"
#include "dem/stages/generate.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

common::Scene full_scene(ContactLaw law) {
  common::Scene scene;
  scene.contact.law = law;
  scene.contact.normal_stiffness = common::stiffness_is_per_area(law) ? 5e9 : 1e9;
  scene.assembly.particles = 60;
  scene.effects = {.friction = true,
                   .local_damping = true,
                   .energy_ledger = true,
                   .contact_damping = true,
                   .rolling_resistance = true,
                   .gravity = true,
                   .mass_scaling = true};
  scene.mass_scaling.smallest_mass = 0.9;
  scene.gravity.acceleration = Vec2(0, -200);  // so that weights count beside the contact forces
  return scene;
}

/// A pile inside of its ring, with every effect at work.
dem::Engine pile(const common::Scene& scene) {
  common::Scene weightless = scene;
  weightless.effects.gravity = false;
  dem::State state;
  state.particles = dem::generate_assembly(scene.assembly, scene.material.density, 5);
  state.next_id = 60;
  state.friction = 0.5;
  dem::Engine engine(weightless, state);
  dem::outline_ring(engine);
  for (int k = 0; k < 100000 && engine.contacts() < 40; ++k) {
    engine.scale_positions(Vec2(1 - 1e-4, 1 - 1e-4));
    engine.step({});
  }
  dem::renew_ring(engine);
  for (int k = 0; k < 20000 && engine.contacts() < 90; ++k) engine.step({0.3, 0.3});
  REQUIRE(engine.contacts() >= 90);
  state = engine.state();
  state.energy = {};
  return {scene, state};
}

double stored(const dem::Engine& engine) {
  return engine.kinetic_energy() + dem::elastic_energy(engine.state(), engine.constants());
}

}  // namespace

TEST_CASE("with every effect at once the ledger closes, and no contact exceeds its limits") {
  for (const ContactLaw law :
       {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential, ContactLaw::foundation}) {
    dem::Engine engine = pile(full_scene(law));
    const double start = stored(engine);
    const auto& area = engine.clock().particles.area;
    double excess = 0, pull = 0;
    int rolling = 0;
    for (int k = 0; k < 2000; ++k) {
      engine.step({-0.1, 0.2});
      for (const dem::Contact& c : engine.state().contacts) {
        const double limit = 0.1 * dem::rolling_radius(area[c.a], area[c.b]) * c.normal_force;
        excess = std::max({excess, std::abs(c.shear_force) - 0.5 * c.normal_force * (1 + 1e-14),
                           std::abs(c.rolling_moment) - limit * (1 + 1e-14)});
        pull = std::max(pull, -c.normal_force);
        rolling += std::abs(c.rolling_moment) > 0.999 * limit;
      }
    }
    const dem::EnergySums& e = engine.clock().energy;
    const double supplied = std::abs(e.boundary_work) + std::abs(e.gravity_work);
    const double residual = e.boundary_work + e.gravity_work - (stored(engine) - start) - e.friction - e.damping -
                            e.contact_damping - e.rolling - e.contact_law_work;
    CAPTURE(static_cast<int>(law), supplied, residual / supplied, e.gravity_work / supplied,
            e.contact_damping / supplied, e.rolling / supplied, e.friction / supplied);
    CHECK(excess <= 0);
    CHECK(pull == 0);
    CHECK(rolling > 100);
    CHECK(e.friction > 0);
    CHECK(e.rolling > 0);
    CHECK(e.contact_damping > 0);
    CHECK(e.gravity_work != 0);
    CHECK(std::abs(residual) < 1e-3 * supplied);
  }
}

TEST_CASE("with every effect at once a resumed engine goes on bit for bit, on three threads as on one") {
  const common::Scene scene = full_scene(ContactLaw::area);
  dem::Engine engine = pile(scene);
  for (int k = 0; k < 200; ++k) engine.step({-0.1, 0.2});
  common::Frame frame = dem::to_frame(engine.state(), scene, common::Stage::shear);
  REQUIRE(frame.contacts.rolling_moment.has_value());
  dem::Engine resumed(scene, dem::to_state(frame), 3);
  engine.restart();
  for (int k = 0; k < 200; ++k) {
    engine.step({-0.1, 0.2});
    resumed.step({-0.1, 0.2});
  }
  const dem::State& a = engine.state();
  const dem::State& b = resumed.state();
  CHECK(a.particles.position == b.particles.position);
  CHECK(a.particles.angular_velocity == b.particles.angular_velocity);
  REQUIRE(a.contacts.size() == b.contacts.size());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    CHECK(a.contacts[k].rolling_moment == b.contacts[k].rolling_moment);
    CHECK(a.contacts[k].normal_force == b.contacts[k].normal_force);
  }
  CHECK(a.energy.rolling == b.energy.rolling);
  CHECK(a.energy.contact_damping == b.energy.contact_damping);
  CHECK(a.energy.gravity_work == b.energy.gravity_work);
}
