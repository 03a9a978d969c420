// Oracle: hand values of the normal laws for a face contact, and the period of the oscillator they make.
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

constexpr double kWidth = 0.4;    // of the upper block; the lower one is wider
constexpr double kLength = 0.47;  // mean diameter of the default scene

common::Scene scene_of(ContactLaw law, double stiffness) {
  common::Scene scene;
  scene.contact.law = law;
  scene.contact.normal_stiffness = stiffness;
  scene.effects.energy_ledger = true;
  return scene;
}

/// A block on a fixed floor, pressed in by `depth`, the whole turned by `angle` about the origin.
dem::State pressed(double depth, double angle) {
  dem::State state;
  const common::Rotation turn(angle);
  bodies::add(state, bodies::box(2, 0.5), turn * Vec2(0, -0.25), angle);
  bodies::add(state, bodies::box(kWidth, 0.3), turn * Vec2(0.1, 0.15 - depth), angle);
  state.particles.boundary[0] = 1;
  return state;
}

}  // namespace

TEST_CASE("face contacts have the forces and energies of their law, whatever the orientation") {
  const double k = 1e9;
  for (const double angle : {0.0, 0.7, 2.5, 4.0}) {
    for (const double depth : {1e-5, 1e-4, 1e-3}) {
      const double area = kWidth * depth;
      struct {
        ContactLaw law;
        double force, energy;
      } const wanted[] = {
          {ContactLaw::mean_depth, k * depth, k * depth * depth / 2},
          {ContactLaw::area, k * area, k * area * depth / 2},
          {ContactLaw::foundation, k * area, k * area * depth / 2},
          {ContactLaw::potential, k * area * kWidth / (kLength * kLength), k * area * area / (2 * kLength * kLength)},
      };
      for (const auto& w : wanted) {
        const dem::Engine engine(scene_of(w.law, k), pressed(depth, angle));
        REQUIRE(engine.state().contacts.size() == 1);
        const dem::Contact& c = engine.state().contacts[0];
        CHECK(c.overlap_area == Approx(area).epsilon(1e-9));
        CHECK(c.overlap_width == Approx(kWidth).epsilon(1e-9));
        CHECK(c.normal_force == Approx(w.force).epsilon(1e-9));
        CHECK(dem::elastic_energy(engine.state(), engine.constants()) == Approx(w.energy).epsilon(1e-9));
        const common::Rotation turn(angle);
        CHECK((c.normal - turn * Vec2(0, 1)).norm() < 1e-9);
        CHECK((engine.forces().force[1] - turn * Vec2(0, w.force)).norm() < 1e-9 * w.force);
        CHECK((engine.forces().force[0] + engine.forces().force[1]).norm() < 1e-12 * w.force);
        CHECK(std::abs(engine.forces().moment[1]) < 1e-8 * w.force * kWidth);
      }
    }
  }
}

TEST_CASE("a block that stays on its floor swings with the period of its contact stiffness") {
  // Each law at a face contact is linear in depth: T = 2 pi sqrt(m / k_law). The floor holds the block by a constant
  // force that balances the mean overlap.
  const double k = 1e8;
  const double depth = 1e-3;
  for (const ContactLaw law :
       {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential, ContactLaw::foundation}) {
    const double stiffness = law == ContactLaw::mean_depth        ? k
                             : common::stiffness_is_per_area(law) ? k * kWidth
                                                                  : k * kWidth * kWidth / (kLength * kLength);
    common::Scene scene = scene_of(law, k);
    scene.time_step.safety = 0.05;
    dem::Engine engine(scene, pressed(1.5 * depth, 0));
    const double mass = engine.state().particles.mass[1];
    const double dt = engine.state().time_step;
    double last = 0, first_crossing = 0, period = 0;
    int crossings = 0;
    while (crossings < 11) {
      engine.edit().particles.velocity[1].y() -= stiffness * depth / mass * dt;
      engine.step({});
      const double swing = engine.state().particles.position[1].y() - (0.15 - depth);
      if (last < 0 && swing >= 0) {
        const double at = engine.state().time - dt * swing / (swing - last);
        if (crossings == 0) first_crossing = at;
        period = (at - first_crossing) / std::max(crossings, 1);
        ++crossings;
      }
      last = swing;
      REQUIRE(engine.state().step < 100000);
    }
    CHECK(period == Approx(6.283185307179586 * std::sqrt(mass / stiffness)).epsilon(2e-3));
  }
}
