// What an effect leaves in memory and in files: everything with it, nothing without. Oracle: the arrays, columns and
// datasets themselves.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "dem/checkpoint.hpp"
#include "dem/effects/mass_scaling.hpp"
#include "dem/explain.hpp"
#include "dem/history.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::Vec2;

namespace {

struct Named {
  const char* name;
  bool common::Effects::*member;
};
constexpr Named kEffects[] = {{"friction", &common::Effects::friction},
                              {"local_damping", &common::Effects::local_damping},
                              {"contact_damping", &common::Effects::contact_damping},
                              {"rolling_resistance", &common::Effects::rolling_resistance},
                              {"gravity", &common::Effects::gravity},
                              {"mass_scaling", &common::Effects::mass_scaling},
                              {"energy_ledger", &common::Effects::energy_ledger}};
constexpr int kCombinations = 1 << 7;

common::Effects combination(int bits) {
  common::Effects effects;
  for (int i = 0; i < 7; ++i) effects.*kEffects[i].member = (bits >> i & 1) != 0;
  return effects;
}

std::set<std::string> names(const std::vector<common::Column>& columns) {
  std::set<std::string> result;
  for (const common::Column& c : columns) result.insert(c.name);
  return result;
}

/// A box that moves into a fixed one, and a fragment-sized one beside.
dem::State bodies_in_touch() {
  dem::State state;
  state.friction = 0.5;
  bodies::add(state, bodies::box(0.5, 0.5), Vec2(0, 0));
  bodies::add(state, bodies::box(0.5, 0.5), Vec2(0.1, 0.499));
  bodies::add(state, bodies::box(0.05, 0.05), Vec2(2, 0));
  state.particles.boundary[0] = 1;
  state.particles.velocity[1] = Vec2(0.1, -0.1);
  state.particles.angular_velocity[1] = 0.2;
  return state;
}

}  // namespace

TEST_CASE("explain lists the arrays of a contact that exist, for every combination of effects") {
  for (int bits = 0; bits < kCombinations; ++bits) {
    common::Scene scene;
    scene.contact.law = common::ContactLaw::area;
    scene.effects = combination(bits);
    const common::Effects& e = scene.effects;
    const std::string text = dem::explain(scene);
    const std::string head = "# state arrays of a contact: ";
    const std::size_t start = text.find(head) + head.size();
    const std::string line = text.substr(start, text.find('\n', start) - start);
    std::string expected = "pair, feature, overlap area, overlap width, point, normal, normal force, load";
    if (e.friction) expected += ", shear displacement";
    if (e.rolling_resistance) expected += ", rolling moment";
    if (e.energy_ledger) expected += ", elastic energy";
    if (e.energy_ledger && e.contact_damping) expected += ", viscous force";
    CHECK(line == expected);

    // The kernel is named after the effects that are compiled into it.
    std::string kernel = "# contact kernel: area";
    for (const char* name : {"friction", "contact_damping", "rolling_resistance", "energy_ledger"}) {
      const auto effect = std::find_if(std::begin(kEffects), std::end(kEffects),
                                       [&](const Named& n) { return std::string(n.name) == name; });
      if (e.*effect->member) kernel += std::string(" + ") + name;
    }
    CHECK(text.find(kernel + "\n") != std::string::npos);
    CHECK((text.find("gravity", text.find("body effects")) != std::string::npos) == e.gravity);
  }
}

TEST_CASE("history and checkpoint have the columns of the effects that exist, and their values") {
  for (int bits = 0; bits < kCombinations; ++bits) {
    common::Scene scene;
    scene.effects = combination(bits);
    const common::Effects& e = scene.effects;
    CAPTURE(bits);
    dem::State state = bodies_in_touch();
    bodies::add(state, bodies::box(0.5, 0.5), Vec2(0.05, 3));
    state.ring = {0, 2, 3};  // around the moving one
    dem::Engine engine(scene, state);
    for (int k = 0; k < 5; ++k) engine.step({});
    const dem::Control control;
    dem::History history(scene);
    history.record(engine, control);
    const std::vector<common::Column> rows = history.take();
    const auto there = names(rows);
    const auto value = [&](const char* name) {
      return std::find_if(rows.begin(), rows.end(), [&](const auto& c) { return c.name == name; })->values.at(0);
    };
    CHECK((there.count("sliding_fraction") == 1) == e.friction);
    CHECK((there.count("energy_residual") == 1) == e.energy_ledger);
    CHECK((there.count("gravity_work") == 1) == (e.energy_ledger && e.gravity));
    CHECK((there.count("contact_damping_dissipation") == 1) == (e.energy_ledger && e.contact_damping));
    CHECK((there.count("rolling_dissipation") == 1) == (e.energy_ledger && e.rolling_resistance));
    CHECK((there.count("added_mass") == 1) == e.mass_scaling);
    CHECK((there.count("scaled_particles") == 1) == e.mass_scaling);
    for (const common::Column& c : rows) CHECK(c.values.size() == 1);
    const dem::EnergySums& energy = engine.state().energy;
    CHECK((energy.gravity_work != 0) == (e.energy_ledger && e.gravity));
    CHECK((energy.contact_damping != 0) == (e.energy_ledger && e.contact_damping));
    if (there.count("gravity_work")) CHECK(value("gravity_work") == energy.gravity_work);
    if (there.count("rolling_dissipation")) CHECK(value("rolling_dissipation") == energy.rolling);
    if (there.count("contact_damping_dissipation")) {
      CHECK(value("contact_damping_dissipation") == energy.contact_damping);
    }
    if (e.mass_scaling) CHECK(value("scaled_particles") == 1);
    if (e.energy_ledger) CHECK(value("kinetic_energy") == engine.kinetic_energy());

    const common::Frame frame = dem::to_frame(engine.state(), scene, common::Stage::shear);
    CHECK(frame.contacts.shear_displacement.has_value() == e.friction);
    CHECK(frame.contacts.rolling_moment.has_value() == e.rolling_resistance);
    const auto kept = names(frame.checkpoint);
    CHECK((kept.count("energy_gravity") == 1) == (e.energy_ledger && e.gravity));
    CHECK((kept.count("energy_rolling") == 1) == (e.energy_ledger && e.rolling_resistance));
    CHECK((kept.count("energy_contact_damping") == 1) == (e.energy_ledger && e.contact_damping));
    CHECK(dem::to_state(frame).energy.gravity_work == energy.gravity_work);
    CHECK(dem::to_state(frame).energy.contact_damping == energy.contact_damping);
  }
}

TEST_CASE("mass scaling raises the lightest to a share of the mean original mass, and says how much that adds") {
  dem::State state = bodies_in_touch();
  auto& p = state.particles;
  p.root[2] = p.root[1];  // a fragment: two originals
  const double mean = (p.mass[0] + p.mass[1] + p.mass[2]) / 2;
  const double least = dem::least_inertial_mass(p, 0.1);
  CHECK(least == Approx(0.1 * mean).epsilon(1e-15));
  const dem::MassScaling scaling = dem::mass_scaling(p, least);
  CHECK(scaling.particles == 1);
  CHECK(scaling.added_mass == Approx((least - p.mass[2]) / (2 * mean)).epsilon(1e-14));
  CHECK(dem::mass_scaling(p, 0).particles == 0);
  dem::InverseInertia inverse;
  inverse.reset(p, least);
  CHECK(inverse.mass[2] == Approx(1 / least).epsilon(1e-15));
  CHECK(inverse.moment[2] == Approx(p.mass[2] / (least * p.inertia[2])).epsilon(1e-15));
  CHECK(inverse.mass[0] == 1 / p.mass[0]);
}
