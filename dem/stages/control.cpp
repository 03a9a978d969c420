#include "dem/stages/control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "dem/boundary/ring.hpp"
#include "dem/checkpoint.hpp"
#include "dem/guards.hpp"
#include "dem/measures.hpp"

namespace dem {
namespace {

// Ball of the ring search, in mean spacings of the original particles: smaller ones fall into the assembly, larger ones
// bridge over hollows.
constexpr double kBallRadius = 1.5;

// Largest normal force, in mean normal forces, between a particle that leaves the boundary and one that was in it: such
// overlaps grew while both were driven, and letting go of a deep one is a blow (13 % of the pressure in one step were
// measured). Contacts of a few mean forces are common in a packing.
constexpr double kReleaseForce = 3;

double mean_normal_force(const State& state) {
  double sum = 0;
  for (const Contact& c : state.contacts) sum += c.normal_force;
  return state.contacts.empty() ? 0 : sum / static_cast<double>(state.contacts.size());
}

struct Entry {
  const char* name;
  const char* unit;
  const char* description;
  double Control::*member;
};

constexpr Entry kEntries[] = {
    {"phase_start", "s", "time at which the phase of the run began", &Control::phase_start},
    {"hold_below", "-", "void ratio at which densification tries to hold", &Control::hold_below},
    {"low_friction", "-", "friction that densification had reached then", &Control::low_friction},
    {"stretch_x", "-", "stretch of the boundary along x since the start of shear", &Control::stretch_x},
    {"stretch_y", "-", "stretch of the boundary along y since the start of shear", &Control::stretch_y},
    {"steps_to_ring", "-", "steps until the boundary ring is found anew", &Control::steps_to_ring},
    {"steps_to_servo", "-", "steps until the stress is measured for the servo", &Control::steps_to_servo},
    {"next_frame", "-", "number of the next frame", &Control::next_frame},
    {"contact_steps", "-", "contacts times steps since the start of shear", &Control::contact_steps},
    {"momentum_error", "-", "largest relative change of linear momentum at a split", &Control::momentum_error},
    {"broken", "-", "particles broken so far", &Control::broken},
    {"solid_area", "m^2", "area of all particles when shear began", &Control::solid_area},
    {"energy_at_start", "J", "elastic and kinetic energy when shear began", &Control::energy_at_start},
};

common::Column column(const std::string& name, const char* unit, const char* description, double value) {
  return {name, unit, description, {value}};
}

std::vector<std::int32_t> ring_of(const Particles& p) {
  require_finite_positions(p);
  double area = 0;
  for (const double a : p.area) area += a;
  // Fragments do not count: the boundary never breaks, and a ball that shrank as others do would trace deeper dents.
  std::vector<std::int64_t> originals = p.root;
  std::sort(originals.begin(), originals.end());
  const auto count = std::unique(originals.begin(), originals.end()) - originals.begin();
  // Centres of particles that fill about four fifths of the plane.
  const double spacing = std::sqrt(1.25 * area / static_cast<double>(count));
  return find_ring(p.position, kBallRadius * spacing);
}

}  // namespace

const char* name_of(Phase phase) {
  switch (phase) {
    case Phase::compaction:
      return "compaction";
    case Phase::relaxation:
      return "relaxation";
    case Phase::confinement:
      return "confinement";
    case Phase::densification:
      return "densification";
    case Phase::hold:
      return "hold";
    case Phase::shear:
      return "shear";
  }
  return "";
}

common::Stage stage_of(Phase phase) {
  switch (phase) {
    case Phase::compaction:
      return common::Stage::compaction;
    case Phase::relaxation:
      return common::Stage::relaxation;
    case Phase::shear:
      return common::Stage::shear;
    default:
      return common::Stage::confinement;
  }
}

std::vector<common::Column> to_columns(const Control& control) {
  std::vector<common::Column> columns;
  columns.push_back(column("phase", "-", "0 compaction, 1 relaxation, 2 confinement, 3 densification, 4 hold, 5 shear",
                           static_cast<double>(control.phase)));
  for (const Entry& e : kEntries) columns.push_back(column(e.name, e.unit, e.description, control.*e.member));
  const auto add_servo = [&](const std::string& axis, const Servo& servo) {
    columns.push_back(
        column("servo_integral_" + axis, "1/s", "integral part of the servo's strain rate", servo.integral));
    columns.push_back(column("servo_rate_" + axis, "1/s", "strain rate in force, compression positive", servo.rate));
  };
  add_servo("x", control.servo_x);
  add_servo("y", control.servo_y);
  return columns;
}

Control read_control(const common::Frame& frame) {
  Control control;
  control.phase = static_cast<Phase>(std::clamp(static_cast<int>(checkpoint_value(frame, "phase")), 0, 5));
  for (const Entry& e : kEntries) control.*e.member = checkpoint_value(frame, e.name);
  control.servo_x = {checkpoint_value(frame, "servo_integral_x"), checkpoint_value(frame, "servo_rate_x")};
  control.servo_y = {checkpoint_value(frame, "servo_integral_y"), checkpoint_value(frame, "servo_rate_y")};
  return control;
}

void outline_ring(Engine& engine) {
  engine.edit().ring = ring_of(engine.state().particles);
}

void renew_ring(Engine& engine) {
  State& state = engine.edit();
  Particles& p = state.particles;
  const double energy_before = engine.kinetic_energy() + elastic_energy(state, engine.constants());
  const double mean_force = mean_normal_force(state);
  const std::vector<std::uint8_t> before = p.boundary;
  state.ring = ring_of(p);
  std::fill(p.boundary.begin(), p.boundary.end(), std::uint8_t{0});
  // Velocities stay: the next step sets them, and its work is the mean over the velocities before and after.
  for (const std::int32_t i : state.ring) p.boundary[i] = 1;
  engine.restart();

  // Boundary particles overlap unhindered: whoever would be pressed hard by the others on leaving them, stays.
  std::vector<std::int32_t> staying;
  for (const Contact& c : state.contacts) {
    if (!before[c.a] || !before[c.b] || c.normal_force <= kReleaseForce * mean_force) continue;
    for (const std::int32_t i : {c.a, c.b}) {
      if (!p.boundary[i]) staying.push_back(i);
    }
  }
  if (!staying.empty()) {
    for (const std::int32_t i : staying) p.boundary[i] = 1;
    engine.restart();
  }
  state.energy.boundary_work += engine.kinetic_energy() + elastic_energy(state, engine.constants()) - energy_before;
}

void require_interior(const State& state) {
  const std::vector<std::uint8_t>& boundary = state.particles.boundary;
  const auto driven = static_cast<std::size_t>(std::count(boundary.begin(), boundary.end(), std::uint8_t{1}));
  const std::size_t rim = std::max(driven, state.ring.size());
  if (state.ring.size() >= 3 && rim < boundary.size()) return;
  throw common::bad_input(fmt::format(
      "assembly.particles: found {}, of which {} lie on the boundary; expected a ring of at least three and "
      "particles inside it",
      boundary.size(), rim));
}

ServoGains sample_gains(const common::Scene& scene, const State& state, double pressure) {
  const double area = ring_area(state);
  double mass = 0;
  for (const double m : state.particles.mass) mass += m;
  // The ring polygon leaves out the outer halves of the boundary particles; a tenth of density hardly moves a gain.
  return servo_gains(scene.servo, pressure, std::sqrt(area * 0.3183098861837907), mass / area, scene.shear.strain_rate);
}

}  // namespace dem
