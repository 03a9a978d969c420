// What stops a run. Oracle: states and rows made by hand on either side of each limit.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "bodies.hpp"
#include "dem/guards.hpp"
#include "dem/history.hpp"

namespace {

using Catch::Matchers::Contains;
using common::Vec2;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Two boxes of 1 and 4 m^2 that do not touch, ids 0 and 1.
dem::State boxes() {
  dem::State state;
  bodies::add(state, bodies::box(1, 1), Vec2(0, 0));
  bodies::add(state, bodies::box(2, 2), Vec2(5, 0));
  return state;
}

common::Scene scene_with(bool damping, bool ledger) {
  common::Scene scene;
  scene.effects.local_damping = damping;
  scene.effects.energy_ledger = ledger;
  return scene;
}

/// What the guard found; an empty guard if it stays silent.
template <class Check>
dem::Finding finding_of(Check&& check) {
  try {
    check();
  } catch (const dem::NumericalFailure& failure) {
    CHECK(failure.code() == common::ExitCode::numerical_failure);
    return failure.finding();
  }
  return {};
}

struct Rows {
  std::vector<double> unbalanced{0.3, 0.025, 0.4};
  double inertial = 1e-4;
  std::int64_t steps = 1000;
  double split_share = 0;
  std::vector<double> stress{2e6, 2e6, 2e6};
};

std::vector<common::Column> history_of(const Rows& rows) {
  const std::size_t n = rows.unbalanced.size();
  return {{"unbalanced_force", "-", "", rows.unbalanced},
          {"inertial_number", "-", "", std::vector<double>(n, rows.inertial)},
          {"servo_rate", "1/s", "", std::vector<double>(n, -0.01)},
          {"stress_xx", "Pa", "", rows.stress}};
}

}  // namespace

TEST_CASE("whatever is no number names its particle and what of it") {
  const dem::State sound = boxes();
  const dem::BodyForces none{{Vec2(0, 0), Vec2(0, 0)}, {0, 0}};
  CHECK_NOTHROW(dem::require_finite(sound.particles, none));
  dem::State large = sound;
  large.particles.position[1] = Vec2(1e300, -1e300);
  large.particles.velocity[0] = Vec2(-1e308, 1e-308);
  CHECK_NOTHROW(dem::require_finite(large.particles, none));
  for (const double bad : {kNotANumber, kInfinity, -kInfinity}) {
    const auto found = [&](auto&& spoil) {
      dem::State state = sound;
      dem::BodyForces forces = none;
      spoil(state.particles, forces);
      const dem::Finding finding = finding_of([&] { dem::require_finite(state.particles, forces); });
      CHECK(finding.guard == "finite");
      CHECK(finding.particles == std::vector<std::int64_t>{1});
      return finding.text;
    };
    CHECK_THAT(found([&](auto& p, auto&) { p.position[1].x() = bad; }), Contains("position x of particle 1"));
    CHECK_THAT(found([&](auto& p, auto&) { p.velocity[1].y() = bad; }), Contains("velocity y of particle 1"));
    CHECK_THAT(found([&](auto& p, auto&) { p.angle[1] = bad; }), Contains("the angle of particle 1"));
    CHECK_THAT(found([&](auto& p, auto&) { p.angular_velocity[1] = bad; }), Contains("angular velocity of particle 1"));
    CHECK_THAT(found([&](auto&, auto& f) { f.force[1].y() = bad; }), Contains("force y of particle 1"));
    CHECK_THAT(found([&](auto&, auto& f) { f.moment[1] = bad; }), Contains("moment of particle 1"));
    dem::State lost = sound;
    lost.particles.position[0].y() = bad;
    CHECK_THAT(finding_of([&] { dem::require_finite_positions(lost.particles); }).text,
               Contains("the position y of particle 0"));
    CHECK_NOTHROW(dem::require_finite_positions(sound.particles));
  }
}

TEST_CASE("a contact deeper than its limit is named, and one that two outlines cannot have") {
  dem::State state = boxes();
  dem::Contact contact;
  contact.b = 1;
  contact.normal = Vec2(0.6, 0.8);
  contact.normal_force = 1;
  contact.overlap_width = 1;
  contact.overlap_area = 0.25;
  const auto found = [&](const dem::Contact& c) {
    state.contacts = {contact, c};
    return finding_of([&] { dem::require_possible_contacts(state, 0.25); });
  };
  CHECK(found(contact).guard.empty());  // at the limit
  dem::Contact deep = contact;
  deep.overlap_area = 0.26;
  CHECK(found(deep).guard == "overlap");
  CHECK(found(deep).particles == std::vector<std::int64_t>{0, 1});
  CHECK_THAT(found(deep).text, Contains("particles 0 and 1 overlap by 0.26") && Contains("guards.overlap"));
  dem::Contact inside = contact;
  inside.overlap_area = 1;  // wholly inside: deep, but possible
  CHECK(found(inside).guard == "overlap");

  const auto impossible = [&](auto&& spoil) {
    dem::Contact c = contact;
    spoil(c);
    return found(c).guard == "contact";
  };
  CHECK(impossible([](auto& c) { c.overlap_area = 1.001; }));
  CHECK(impossible([](auto& c) { c.overlap_area = kNotANumber; }));
  CHECK(impossible([](auto& c) { c.normal_force = -1; }));
  CHECK(impossible([](auto& c) { c.normal_force = kInfinity; }));
  CHECK(impossible([](auto& c) { c.shear_force = kNotANumber; }));
  CHECK(impossible([](auto& c) { c.overlap_width = -1e-9; }));
  CHECK(impossible([](auto& c) { c.normal = Vec2(0.6, 0.81); }));
}

TEST_CASE("a time step that gets nowhere names the particle that sets it") {
  dem::State state = boxes();
  state.time_step = 1e-3;
  CHECK_NOTHROW(dem::require_progress(state, 1, 1000));
  const dem::Finding finding = finding_of([&] { dem::require_progress(state, 1.01, 1000); });
  CHECK(finding.guard == "steps");
  CHECK(finding.particles == std::vector<std::int64_t>{0});
  CHECK_THAT(finding.text, Contains("1.01e+03 steps") && Contains("0 of 2.5e+03 kg"));
}

TEST_CASE("a run that rattles from frame to frame is stopped, one that is shaken by a split is not") {
  const common::Scene scene = scene_with(true, false);
  dem::State state = boxes();
  const dem::Engine engine(scene, state);
  const auto found = [&](const common::Scene& s, const Rows& rows) {
    return finding_of([&] { dem::require_rest(s, history_of(rows), engine, rows.steps, rows.split_share); });
  };
  CHECK(found(scene, {}).guard.empty());
  Rows rattling;
  rattling.unbalanced = {0.3, 0.03, 0.4};
  CHECK(found(scene, rattling).guard.empty());
  rattling.unbalanced[1] = 0.035;
  const dem::Finding finding = found(scene, rattling);
  CHECK(finding.guard == "unbalanced_force");
  CHECK_THAT(finding.text, Contains("0.035") && Contains("time_step.safety") && Contains("particle 0 at (0, 0)"));
  CHECK(finding.particles.size() == 1);
  common::Scene tolerant = scene;
  tolerant.guards.unbalanced_force = 0.036;
  CHECK(found(tolerant, rattling).guard.empty());
  // Frames close together do not see the end of what a split shakes.
  rattling.steps = 800;
  CHECK(found(scene, rattling).guard.empty());
  rattling.unbalanced[1] = 0.04;
  CHECK_THAT(found(scene, rattling).text, Contains("expected below 0.0375"));
  rattling.steps = 0;
  CHECK(found(scene, rattling).guard.empty());
  rattling.steps = 1000;
  // Nor does a sample of which much is split find rest at once.
  rattling.split_share = 0.02;
  CHECK(found(scene, rattling).guard == "unbalanced_force");
  rattling.split_share = 0.027;
  CHECK(found(scene, rattling).guard.empty());
  rattling.split_share = 0;
  Rows sparse = rattling;  // one row for a whole frame is judged like many
  sparse.unbalanced = {0.04};
  CHECK(found(scene, sparse).guard == "unbalanced_force");
  // Without damping nothing comes to rest, and fast loading is not quasi-static.
  CHECK(found(scene_with(false, false), rattling).guard.empty());
  rattling.inertial = 0.02;
  CHECK(found(scene, rattling).guard.empty());
}

TEST_CASE("a ledger that does not close stops the run, and the fastest particle is named") {
  common::Scene scene = scene_with(true, true);
  scene.preparation.confining_pressure = 1;
  dem::State state = boxes();
  dem::Engine engine(scene, state);
  dem::Control control;
  const auto found = [&](const common::Scene& s, double residual) {
    engine.edit().energy = {};
    engine.edit().energy.boundary_work = -100;
    engine.edit().energy.damping = -100 - residual;
    return finding_of([&] {
      dem::require_balanced_energy(s, engine, control, dem::energy_residual(engine, control),
                                   dem::elastic_energy(engine.state(), engine.constants()));
    });
  };
  for (const double sign : {1.0, -1.0}) {
    CHECK(found(scene, sign * 4.99).guard.empty());
    CHECK(found(scene, sign * 5.01).guard == "energy_residual");
  }
  scene.guards.energy_residual = 0.06;
  CHECK(found(scene, 5.01).guard.empty());
  // What was stored at the start counts where little work has been done; without motion no energy is anywhere.
  engine.edit().particles.velocity[1] = Vec2(0, 0.1);
  control.energy_at_start = 50;  // 0.5 10,000 kg (0.1 m/s)^2
  const dem::Finding finding = found(scene, 7);
  CHECK(finding.particles == std::vector<std::int64_t>{1});
  CHECK_THAT(finding.text, Contains("residual is 7 J") && Contains("50 J, is in particle 1"));
  // A sample that nothing touches yet stores nothing, and its first contact little: 1e-4 of 2 MPa times 5 m^2 is 1000
  // J.
  scene.guards.energy_residual = 0.05;
  scene.preparation.confining_pressure = 2e6;
  CHECK(found(scene, 49.9).guard.empty());
  CHECK(found(scene, 50.1).guard == "energy_residual");
}

TEST_CASE("a lateral stress that is lost stops the run, one that is on its way does not") {
  common::Scene scene;
  const auto found = [&](const std::vector<double>& stress) {
    Rows rows;
    rows.unbalanced.assign(stress.size(), 0.01);
    rows.stress = stress;
    return finding_of([&] { dem::require_lateral_stress(scene, history_of(rows)); }).guard;
  };
  CHECK(found({2e6, 2.1e6, 1.9e6}).empty());
  CHECK(found({1.3e6, 1.35e6, 1.3e6}) == "servo_error");
  CHECK(found({2.7e6, 2.7e6, 2.7e6}) == "servo_error");
  CHECK(found({1.3e6, 1.41e6, 1.3e6}).empty());  // within 30 % once
  CHECK(found({0.5e6, 0.6e6, 0.7e6}).empty());   // a pressure jump that is being followed
  CHECK(found({5e6, 4.9e6, 4.8e6}).empty());     // and an unloading
  CHECK(found({0.5e6}).empty());                 // one row says nothing of where it goes
  scene.guards.servo_error = 0.36;
  CHECK(found({1.3e6, 1.35e6, 1.3e6}).empty());
}

TEST_CASE("a refused analysis stops the run unless the scene says otherwise") {
  common::Scene scene;
  common::Split split;
  split.frame = 7;
  CHECK_NOTHROW(dem::require_answers(scene, split));
  split.refusals.particle = {12, 40};
  split.refusals.reason = {"no mesh", "another"};
  const dem::Finding finding = finding_of([&] { dem::require_answers(scene, split); });
  CHECK(finding.particles == std::vector<std::int64_t>{12, 40});
  CHECK_THAT(finding.text, Contains("frame 7") && Contains("particle 12: no mesh (and for 1 more)"));
  scene.guards.refusals = common::Refusals::go_on;
  CHECK_NOTHROW(dem::require_answers(scene, split));
}
