// Oracle: rigid-body impact at a point (Brach 1991; Stronge 2000). A body of mass m and moment of inertia I touches a
// fixed plane with a vertex at (x, y) from its centroid, y < 0. With restitution 1 and sliding throughout,
//
//   P = -2 w / (1/m + x^2/I + s mu x y / I),  Q = -s mu P,  dv = (Q, P)/m,  dw = (x P - y Q)/I
//
// w: normal velocity of the vertex before, s: sign of its sliding, P and Q: normal and tangential impulse. The laws'
// overlaps are finite: what deviates falls with the depth over the size, here 1e-4.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "dem/engine.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

constexpr double kRadius = 0.25;

struct Impact {
  Vec2 velocity_before, velocity;
  double spin = 0, mass = 0, inertia = 0, energy_before = 0, energy = 0;
  Vec2 impulse = Vec2::Zero();  ///< sum of the contact forces over the steps
  Vec2 arm = Vec2::Zero();      ///< from the centroid to the vertex
  double depth = 0;             ///< largest [m]
  dem::EnergySums sums;
};

common::Scene scene_of(ContactLaw law) {
  common::Scene scene;
  scene.contact.law = law;
  // Stiff enough for depths of 1e-4 of the size; of the area and the potential law a vertex feels a small part.
  scene.contact.normal_stiffness = law == ContactLaw::mean_depth        ? 1e12
                                   : common::stiffness_is_per_area(law) ? 4e16
                                                                        : 1e20;
  scene.contact.tangential_stiffness = 1e13;
  scene.effects.energy_ledger = true;
  scene.time_step.safety = law == ContactLaw::mean_depth ? 0.02 : 0.1;  // of a whole face, which a vertex is not
  return scene;
}

/// A hexagon whose lowest vertex hits the upper face of a fixed block; `tilt` turns that vertex out of the vertical.
Impact hit(const common::Scene& scene, double friction, double tilt, const Vec2& velocity) {
  dem::State state;
  state.friction = friction;
  bodies::add(state, bodies::box(0.25, 1), Vec2(0, -0.5));
  bodies::add(state, bodies::hexagon(kRadius), Vec2(0, 0), tilt - 1.5707963267948966);
  auto& p = state.particles;
  p.boundary[0] = 1;
  Impact result;
  result.arm = common::Rotation(p.angle[1]) * Vec2(kRadius, 0);
  p.position[1] = Vec2(0, 1e-7 - result.arm.y());
  p.velocity[1] = result.velocity_before = velocity;
  result.mass = p.mass[1];
  result.inertia = p.inertia[1];
  dem::Engine engine(scene, state);
  REQUIRE(engine.state().contacts.empty());
  result.energy_before = engine.kinetic_energy();
  for (bool touched = false;;) {
    engine.step({});
    result.impulse += engine.forces().force[1] * engine.state().time_step;
    const bool apart = engine.contacts() == 0;
    for (const dem::Contact& c : engine.state().contacts) {
      result.depth = std::max(result.depth, 2 * c.overlap_area / c.overlap_width);
    }
    if (touched && apart) break;
    touched |= !apart;
    if (engine.clock().time > 1) FAIL("the body does not come off");
  }
  result.velocity = engine.state().particles.velocity[1];
  result.spin = engine.state().particles.angular_velocity[1];
  result.energy = engine.kinetic_energy();
  result.sums = engine.state().energy;
  return result;
}

struct Theory {
  Vec2 velocity;
  double spin;
};

Theory rigid_impact(const Impact& i, double friction) {
  const double x = i.arm.x(), y = i.arm.y();
  const double slide = i.velocity_before.x() > 0 ? 1 : -1;
  const double normal =
      -2 * i.velocity_before.y() / (1 / i.mass + x * x / i.inertia + slide * friction * x * y / i.inertia);
  const double tangential = -slide * friction * normal;
  return {i.velocity_before + Vec2(tangential, normal) / i.mass, (x * normal - y * tangential) / i.inertia};
}

}  // namespace

TEST_CASE("a vertex that hits a fixed block rebounds as in rigid-body impact, and without friction keeps its energy") {
  for (const ContactLaw law :
       {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential, ContactLaw::foundation}) {
    for (const double tilt : {0.0, 0.2, -0.35}) {
      const Impact i = hit(scene_of(law), 0, tilt, Vec2(3, -1));
      const Theory theory = rigid_impact(i, 0);
      CAPTURE(static_cast<int>(law), tilt, i.depth / kRadius, (i.velocity - theory.velocity).norm(),
              i.spin - theory.spin, i.energy / i.energy_before - 1);
      CHECK(i.depth < 3e-4 * kRadius);
      CHECK(i.velocity.x() == 3);
      CHECK((i.velocity - theory.velocity).norm() < 5e-4);
      CHECK(std::abs(i.spin - theory.spin) * kRadius < 5e-4);
      CHECK(std::abs(i.energy / i.energy_before - 1) < (law == ContactLaw::potential ? 1e-8 : 5e-5));
    }
  }
}

TEST_CASE("sliding throughout, the tangential impulse is mu times the normal one, and the spin follows") {
  for (const ContactLaw law :
       {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential, ContactLaw::foundation}) {
    for (const double tilt : {0.0, 0.2, -0.35}) {
      for (const double along : {6.0, -6.0}) {
        common::Scene scene = scene_of(law);
        scene.effects.friction = true;
        constexpr double kFriction = 0.3;
        const Impact i = hit(scene, kFriction, tilt, Vec2(along, -1));
        const Theory theory = rigid_impact(i, kFriction);
        const double slide = along > 0 ? 1 : -1;
        CAPTURE(static_cast<int>(law), tilt, along, (i.velocity - theory.velocity).norm(), i.spin - theory.spin,
                i.impulse.x() / i.impulse.y());
        CHECK(i.impulse.x() == Approx(-slide * kFriction * i.impulse.y()).epsilon(1e-12));
        CHECK((i.velocity - theory.velocity).norm() < 5e-4);
        CHECK(std::abs(i.spin - theory.spin) * kRadius < 1e-3);
        const double left = i.energy_before - i.energy - i.sums.friction - i.sums.contact_law_work;
        CAPTURE(left / i.energy_before, i.sums.friction / i.energy_before);
        CHECK(i.sums.friction > 0.02 * i.energy_before);
        CHECK(std::abs(left) < 1e-6 * i.energy_before);
      }
    }
  }
}
