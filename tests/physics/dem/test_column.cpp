// Oracles: springs in series, weights, and Newton's first law, for blocks that touch with whole faces.
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
constexpr double kWidth = 0.5;
constexpr double kHeight = 0.3;

common::Scene scene_of(ContactLaw law) {
  common::Scene scene;
  scene.contact.law = law;
  scene.contact.normal_stiffness = common::stiffness_is_per_area(law) ? 5e9 : 1e9;
  scene.effects.friction = true;
  scene.effects.local_damping = true;
  return scene;
}

/// Slope dF/d depth of a face contact [N/m].
double face_stiffness(const common::Scene& scene) {
  const double k = scene.contact.normal_stiffness;
  const double length = 0.5 * (scene.assembly.diameter_min + scene.assembly.diameter_max);
  switch (scene.contact.law) {
    case ContactLaw::mean_depth:
      return k;
    case ContactLaw::area:
    case ContactLaw::foundation:
      return k * kWidth;
    default:
      return k * kWidth * kWidth / (length * length);
  }
}

/// Fixed blocks below and, with a lid, above `blocks` free ones; faces just touch.
dem::State column(int blocks, bool lid) {
  dem::State state;
  state.friction = 0.5;
  const int all = blocks + (lid ? 2 : 1);
  for (int i = 0; i < all; ++i) bodies::add(state, bodies::box(kWidth, kHeight), Vec2(0, i * kHeight));
  state.particles.boundary.front() = 1;
  if (lid) state.particles.boundary.back() = 1;
  return state;
}

}  // namespace

TEST_CASE("a column of blocks is as stiff as its contacts in series") {
  for (const ContactLaw law : kLaws) {
    for (const int blocks : {1, 4, 9}) {
      const common::Scene scene = scene_of(law);
      dem::State state = column(blocks, true);
      const double shortening = 1e-4;
      state.particles.position.back().y() -= shortening;
      dem::Engine engine(scene, state);
      for (int k = 0; k < 20000; ++k) engine.step({});
      const double force = face_stiffness(scene) * shortening / (blocks + 1);
      REQUIRE(engine.state().contacts.size() == static_cast<std::size_t>(blocks) + 1);
      CAPTURE(static_cast<int>(law), blocks, force);
      for (const dem::Contact& c : engine.state().contacts) {
        CHECK(c.normal_force == Approx(force).epsilon(1e-9));
        CHECK(std::abs(c.shear_force) < 1e-9 * force);
        CHECK(c.overlap_area == Approx(kWidth * shortening / (blocks + 1)).epsilon(1e-9));
      }
      CHECK(engine.forces().force.back().y() == Approx(force).epsilon(1e-9));
      CHECK(engine.health().unbalanced_force < 1e-9);
    }
  }
}

TEST_CASE("a block on a face oscillates with the leapfrog's frequency of a mass on that spring") {
  for (const ContactLaw law : kLaws) {
    common::Scene scene = scene_of(law);
    scene.effects.local_damping = false;
    scene.time_step.safety = 0.1;
    dem::State state = column(1, true);
    // Between two faces 1e-4 deep; a push moves it within the overlap.
    state.particles.position[1].y() -= 1e-4;
    state.particles.position[2].y() -= 2e-4;
    dem::Engine engine(scene, state);
    const auto& p = engine.state().particles;
    const double mean = p.position[1].y();
    engine.edit().particles.velocity[1].y() = 0.01;
    engine.restart();
    const double dt = engine.state().time_step;
    const double omega = std::sqrt(2 * face_stiffness(scene) / p.mass[1]);
    const double discrete = 2 / dt * std::asin(0.5 * omega * dt);
    double crossing = 0;
    int crossings = 0;
    double last = 0;
    while (crossings < 41) {
      engine.step({});
      const double now = engine.state().particles.position[1].y() - mean;
      if (last != 0 && (last > 0) != (now > 0)) {
        if (crossings++ == 0 || crossings == 41) {
          const double at = engine.state().time - dt * now / (now - last);
          crossing = crossings == 1 ? at : at - crossing;
        }
      }
      last = now;
    }
    CAPTURE(static_cast<int>(law));
    CHECK(40 * 3.141592653589793 / crossing == Approx(discrete).epsilon(1e-5));
  }
}

TEST_CASE("a stack at rest carries the weights above and does not drift, with true masses also where they are scaled") {
  constexpr int kBlocks = 6;
  for (const ContactLaw law : kLaws) {
    for (const bool scaled : {false, true}) {
      common::Scene scene = scene_of(law);
      scene.effects.gravity = true;
      scene.effects.mass_scaling = scaled;
      scene.mass_scaling.smallest_mass = 1;
      dem::State state = column(kBlocks, false);
      state.particles.mass[3] *= 0.2;  // a light one, which scaling raises
      state.particles.inertia[3] *= 0.2;
      dem::Engine engine(scene, state);
      for (int k = 0; k < 40000; ++k) engine.step({});
      const std::vector<Vec2> settled = engine.state().particles.position;
      for (int k = 0; k < 100000; ++k) engine.step({});
      const auto& p = engine.state().particles;
      double drift = 0, weight = 0, wrong = 0;
      for (int i = kBlocks; i > 0; --i) {
        drift = std::max(drift, (p.position[i] - settled[i]).norm());
        weight += p.mass[i] * 9.81;
        const dem::Contact& below = engine.state().contacts[i - 1];
        REQUIRE(below.b == i);
        wrong = std::max(wrong, std::abs(below.normal_force / weight - 1));
      }
      CAPTURE(static_cast<int>(law), scaled, drift / kWidth, wrong, engine.health().unbalanced_force);
      CHECK(engine.state().contacts.size() == kBlocks);
      CHECK(wrong < 1e-9);
      CHECK(drift < 1e-12 * kWidth);
      CHECK(engine.health().unbalanced_force < 1e-9);
    }
  }
}
