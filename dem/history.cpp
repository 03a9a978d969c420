#include "dem/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "common/error.hpp"
#include "dem/effects/mass_scaling.hpp"
#include "dem/measures.hpp"
#include "dem/stages/prepare.hpp"

namespace dem {
namespace {

struct Definition {
  const char* name;
  const char* unit;
  const char* description;
};

constexpr Definition kAlways[] = {
    {"step", "-", "steps since the start of the stage"},
    {"time", "s", "time since the start of the stage"},
    {"axial_strain", "-", "1 - H/H0 along y, compression positive"},
    {"lateral_strain", "-", "1 - W/W0 along x, compression positive"},
    {"volumetric_strain", "-", "1 - A/A0 of the boundary's deformation, compression positive"},
    {"stress_xx", "Pa", "mean stress, Eq. 13, compression positive"},
    {"stress_yy", "Pa", "mean stress, Eq. 13, compression positive"},
    {"stress_xy", "Pa", "mean stress, Eq. 13, compression positive"},
    {"stress_interior_xx", "Pa", "mean over the ellipse of 0.7 of the ring's axes, compression positive"},
    {"stress_interior_yy", "Pa", "mean over the ellipse of 0.7 of the ring's axes, compression positive"},
    {"void_ratio", "-", "in the scene's definition"},
    {"void_ratio_e1", "-", "ring polygon / solids inside it - 1"},
    {"void_ratio_e2", "-", "e1 with the overlaps subtracted from the solids"},
    {"void_ratio_e4", "-", "ring polygon / area of the particles that are not in the ring - 1"},
    {"assembly_area", "m^2", "area of the polygon that joins the ring centroids"},
    {"solid_area", "m^2", "area of all particles"},
    {"particles", "-", "number of particles"},
    {"escaped", "-", "particles outside the ring that touch nothing"},
    {"contacts", "-", "number of contacts in force"},
    {"broken", "-", "particles broken so far"},
    {"unbalanced_force", "-", "mean |sum F| of the free particles / mean normal force"},
    {"inertial_number", "-", "strain rate * diameter * sqrt(density / mean stress)"},
    {"servo_rate", "1/s", "lateral strain rate in force, compression positive"},
    {"friction_coefficient", "-", "Coulomb coefficient in force"},
    {"contact_steps", "-", "contacts times steps since the start of shear"},
    {"momentum_error", "-", "largest relative change of linear momentum at a split"},
};
constexpr Definition kFriction[] = {{"sliding_fraction", "-", "contacts at the Coulomb limit / contacts"}};
constexpr Definition kLedger[] = {
    {"kinetic_energy", "J", "of the free particles"},
    {"elastic_energy", "J", "stored in the contacts"},
    {"boundary_work", "J", "work of the boundary since the start of shear"},
    {"friction_dissipation", "J", "since the start of shear"},
    {"damping_dissipation", "J", "since the start of shear"},
    {"contact_law_work", "J", "path-dependent work of the normal law since the start of shear"},
    {"released_by_breakage", "J", "energy that vanished at splits since the start of shear"},
    {"energy_residual", "J", "boundary work and gravity work less all other entries"},
};
// An effect's entry of the ledger.
struct LedgerEntry {
  bool common::Effects::*effect;
  Definition definition;
  double EnergySums::*member;
};
constexpr LedgerEntry kEffectEntries[] = {
    {&common::Effects::contact_damping,
     {"contact_damping_dissipation", "J", "since the start of shear"},
     &EnergySums::contact_damping},
    {&common::Effects::rolling_resistance,
     {"rolling_dissipation", "J", "since the start of shear"},
     &EnergySums::rolling},
    {&common::Effects::gravity,
     {"gravity_work", "J", "work of the weights since the start of shear"},
     &EnergySums::gravity_work},
};
constexpr Definition kMassScaling[] = {
    {"scaled_particles", "-", "particles that move with a raised mass"},
    {"added_mass", "-", "raised masses / true masses of all particles - 1"},
};

}  // namespace

double energy_residual(const Engine& engine, const Control& control) {
  const State& state = engine.state();
  const double stored = elastic_energy(state, engine.constants()) + engine.kinetic_energy();
  const EnergySums& e = state.energy;
  return e.boundary_work + e.gravity_work - (stored - control.energy_at_start) - e.friction - e.damping -
         e.contact_damping - e.rolling - e.contact_law_work - e.released_by_breakage;
}

History::History(const common::Scene& scene) : scene_(scene) {
  const auto add = [&](const auto& definitions) {
    for (const Definition& d : definitions) columns_.push_back({d.name, d.unit, d.description, {}});
  };
  add(kAlways);
  if (scene.effects.friction) add(kFriction);
  if (scene.effects.energy_ledger) {
    add(kLedger);
    for (const LedgerEntry& entry : kEffectEntries) {
      if (scene.effects.*entry.effect) add(std::span(&entry.definition, 1));
    }
  }
  if (scene.effects.mass_scaling) add(kMassScaling);
}

void History::record(const Engine& engine, const Control& control) {
  const State& state = engine.state();
  const double area = ring_area(state);
  const auto stress = mean_stress(state, area);
  const auto interior = interior_stress(state, area);
  const VoidRatios e = void_ratios(state);
  const Health health = engine.health();
  double solid = 0;
  for (const double a : state.particles.area) solid += a;
  const double mean = 0.5 * (stress[0] + stress[1]);
  const double rate =
      std::max(std::abs(control.servo_x.rate),
               control.phase == Phase::shear ? scene_.shear.strain_rate : std::abs(control.servo_y.rate));
  const double inertial = mean > 0 ? rate * engine.constants().length * std::sqrt(scene_.material.density / mean) : 0;

  std::vector<double> row = {
      static_cast<double>(state.step),
      state.time,
      control.axial_strain(),
      control.lateral_strain(),
      1 - control.stretch_x * control.stretch_y,
      stress[0],
      stress[1],
      stress[2],
      interior[0],
      interior[1],
      void_ratio(state, scene_.preparation.definition),
      e.e1,
      e.e2,
      e.e4,
      area,
      solid,
      static_cast<double>(state.particles.size()),
      static_cast<double>(e.escaped),
      static_cast<double>(state.contacts.size()),
      control.broken,
      health.unbalanced_force,
      inertial,
      control.servo_x.rate,
      state.friction,
      control.contact_steps,
      control.momentum_error,
  };
  if (scene_.effects.friction) row.push_back(health.sliding_fraction);
  if (scene_.effects.energy_ledger) {
    row.insert(row.end(),
               {engine.kinetic_energy(), elastic_energy(state, engine.constants()), state.energy.boundary_work,
                state.energy.friction, state.energy.damping, state.energy.contact_law_work,
                state.energy.released_by_breakage, energy_residual(engine, control)});
    for (const LedgerEntry& entry : kEffectEntries) {
      if (scene_.effects.*entry.effect) row.push_back(state.energy.*entry.member);
    }
  }
  if (scene_.effects.mass_scaling) {
    const MassScaling scaling = mass_scaling(state.particles, engine.least_mass());
    row.insert(row.end(), {scaling.particles, scaling.added_mass});
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (!std::isfinite(row[i])) {
      throw common::numerical_failure(fmt::format("step {}, axial strain {:.5f}: {} is {}", state.step,
                                                  control.axial_strain(), columns_[i].name, row[i]));
    }
    columns_[i].values.push_back(row[i]);
  }
}

double History::last(const std::string& name) const {
  return std::find_if(columns_.begin(), columns_.end(), [&](const auto& c) { return c.name == name; })->values.back();
}

std::vector<common::Column> History::take() {
  std::vector<common::Column> taken = columns_;
  for (common::Column& c : columns_) c.values.clear();
  return taken;
}

}  // namespace dem
