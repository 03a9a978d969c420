#include "dem/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"

namespace dem {
namespace {

struct EnergyEntry {
  const char* name;
  const char* description;
  double EnergySums::*member;
  bool common::Effects::*effect = nullptr;  // that it belongs to besides the ledger
};

constexpr EnergyEntry kEnergies[] = {
    {"energy_boundary_work", "work of the boundary since the start of shear", &EnergySums::boundary_work},
    {"energy_friction", "dissipated by friction since the start of shear", &EnergySums::friction},
    {"energy_damping", "dissipated by damping since the start of shear", &EnergySums::damping},
    {"energy_contact_law", "path-dependent work of the normal law since the start of shear",
     &EnergySums::contact_law_work},
    {"energy_contact_damping", "dissipated by contact damping since the start of shear", &EnergySums::contact_damping,
     &common::Effects::contact_damping},
    {"energy_rolling", "dissipated by rolling resistance since the start of shear", &EnergySums::rolling,
     &common::Effects::rolling_resistance},
    {"energy_gravity", "work of the weights since the start of shear", &EnergySums::gravity_work,
     &common::Effects::gravity},
    {"energy_released", "energy that vanished at splits since the start of shear", &EnergySums::released_by_breakage},
};

}  // namespace

double checkpoint_value(const common::Frame& frame, const std::string& name) {
  for (const common::Column& c : frame.checkpoint) {
    if (c.name == name && c.values.size() == 1) return c.values[0];
  }
  throw common::bad_input(
      fmt::format("frame {}: dataset checkpoint/{} is missing or not one number; this file is no checkpoint of dem",
                  frame.frame, name));
}

std::vector<std::int32_t> indices_of(const std::vector<std::int64_t>& ids, const Particles& particles) {
  std::vector<std::int32_t> indices;
  indices.reserve(ids.size());
  for (const std::int64_t id : ids) {
    const auto found = std::lower_bound(particles.id.begin(), particles.id.end(), id);
    if (found == particles.id.end() || *found != id) {
      throw common::bad_input(fmt::format("particle {} is named but not in particles/id", id));
    }
    indices.push_back(static_cast<std::int32_t>(found - particles.id.begin()));
  }
  return indices;
}

std::vector<Contact> contacts_in(const common::Contacts& contacts, const Particles& particles) {
  const std::vector<std::int32_t> a = indices_of(contacts.a, particles);
  const std::vector<std::int32_t> b = indices_of(contacts.b, particles);
  std::vector<Contact> result(contacts.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    Contact& c = result[i];
    c.a = a[i];
    c.b = b[i];
    if (i < contacts.point.size()) c.point = contacts.point[i];
    if (i < contacts.normal.size()) c.normal = contacts.normal[i];
    if (i < contacts.normal_force.size()) c.normal_force = contacts.normal_force[i];
    if (i < contacts.shear_force.size()) c.shear_force = contacts.shear_force[i];
    if (i < contacts.overlap_area.size()) c.overlap_area = contacts.overlap_area[i];
    if (i < contacts.overlap_width.size()) c.overlap_width = contacts.overlap_width[i];
    if (contacts.shear_displacement) c.shear_displacement = (*contacts.shear_displacement)[i];
    if (contacts.rolling_moment) c.rolling_moment = (*contacts.rolling_moment)[i];
  }
  return result;
}

common::Frame to_frame(const State& state, const common::Scene& scene, common::Stage stage) {
  common::Frame frame;
  frame.step = state.step;
  frame.time = state.time;
  frame.stage = stage;
  frame.seed = scene.seed;
  frame.next_id = state.next_id;
  frame.friction = state.friction;
  frame.particles = state.particles;

  common::Contacts& contacts = frame.contacts;
  if (scene.effects.friction) contacts.shear_displacement.emplace();
  if (scene.effects.rolling_resistance) contacts.rolling_moment.emplace();
  for (const Contact& c : state.contacts) {
    contacts.a.push_back(state.particles.id[c.a]);
    contacts.b.push_back(state.particles.id[c.b]);
    contacts.point.push_back(c.point);
    contacts.normal.push_back(c.normal);
    contacts.force.push_back(c.force());
    contacts.normal_force.push_back(c.normal_force);
    contacts.shear_force.push_back(c.shear_force);
    contacts.overlap_area.push_back(c.overlap_area);
    contacts.overlap_width.push_back(c.overlap_width);
    if (contacts.shear_displacement) contacts.shear_displacement->push_back(c.shear_displacement);
    if (contacts.rolling_moment) contacts.rolling_moment->push_back(c.rolling_moment);
  }
  for (const std::int32_t i : state.ring) frame.ring.push_back(state.particles.id[i]);

  frame.checkpoint.push_back({"time_step", "s", "dt", {state.time_step}});
  if (scene.effects.energy_ledger) {
    for (const EnergyEntry& e : kEnergies) {
      if (e.effect && !(scene.effects.*e.effect)) continue;
      frame.checkpoint.push_back({e.name, "J", e.description, {state.energy.*e.member}});
    }
  }
  return frame;
}

State to_state(const common::Frame& frame) {
  State state;
  state.particles = frame.particles;
  state.contacts = contacts_in(frame.contacts, state.particles);
  state.ring = indices_of(frame.ring, state.particles);
  state.step = frame.step;
  state.time = frame.time;
  state.time_step = checkpoint_value(frame, "time_step");
  state.friction = frame.friction;
  state.next_id = frame.next_id;
  // A scene without the ledger leaves none of them; one without an effect leaves out that effect's.
  const bool ledger = std::any_of(frame.checkpoint.begin(), frame.checkpoint.end(), [](const common::Column& c) {
    return c.name.starts_with("energy_") && c.name != "energy_at_start";
  });
  if (ledger) {
    for (const EnergyEntry& e : kEnergies) {
      const bool there = std::any_of(frame.checkpoint.begin(), frame.checkpoint.end(),
                                     [&](const common::Column& c) { return c.name == e.name; });
      if (there || !e.effect) state.energy.*e.member = checkpoint_value(frame, e.name);
    }
  }
  return state;
}

}  // namespace dem
