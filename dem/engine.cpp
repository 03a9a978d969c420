#include "dem/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "dem/effects/local_damping.hpp"

namespace dem {
namespace {

// As a share of the scene's smallest diameter; the rebuild rate and the number of idle pairs balance near it.
constexpr double kSkin = 0.06;

}  // namespace

Engine::Engine(const common::Scene& scene, State state)
    : effects_(scene.effects),
      damping_(scene.damping.local),
      safety_(scene.time_step.safety),
      constants_(contact_constants(scene)),
      kernel_(select_contact_kernel(scene.contact.law, scene.effects)),
      neighbours_(kSkin * scene.assembly.diameter_min),
      state_(std::move(state)) {
  restart();
}

void Engine::restart() {
  const Particles& p = state_.particles;
  work_.outlines.radius.resize(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.outline(i).size() > std::size_t{common::kMaxParticleVertices}) {
      throw common::bad_input(fmt::format("particle {}: its outline has {} vertices, expected at most {}", p.id[i],
                                          p.outline(i).size(), common::kMaxParticleVertices));
    }
    work_.outlines.radius[i] = common::radius_about(p.outline(i), Vec2::Zero());
  }
  state_.time_step = stable_time_step();
  neighbours_.rebuild(p, work_.outlines.radius, work_.pairs);
  // No time passes here, so no work is done: what changes is booked by whoever changed it.
  const EnergySums energy = state_.energy;
  evaluate(0);
  state_.energy = energy;
}

// The contact law's steepest slope is that of the widest face in the assembly.
double Engine::stable_time_step() const {
  const Particles& p = state_.particles;
  double edge = 0;
  double mass = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < p.size(); ++i) {
    const PolygonView outline = p.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      edge = std::max(edge, (outline[(k + 1) % outline.size()] - outline[k]).norm());
    }
    mass = std::min(mass, p.mass[i]);
  }
  double stiffness = kernel_.stiffness_bound(edge, constants_);
  if (effects_.friction) stiffness = std::max(stiffness, constants_.tangential_stiffness);
  return safety_ * std::sqrt(mass / stiffness);
}

void Engine::evaluate(double dt) {
  transform_outlines(state_.particles, work_.outlines.vertices);
  kernel_.evaluate(state_, work_, constants_, dt);
}

void Engine::step(const StrainRate& rate) {
  if (effects_.local_damping) apply_local_damping(state_, work_.forces, damping_, effects_.energy_ledger);
  advance(state_, work_.forces, rate, effects_.energy_ledger);
  if (neighbours_.outdated(state_.particles, work_.outlines.radius)) {
    neighbours_.rebuild(state_.particles, work_.outlines.radius, work_.pairs);
  }
  evaluate(state_.time_step);
  contact_steps_ += static_cast<std::int64_t>(state_.contacts.size());
}

void Engine::scale_positions(double factor) {
  for (Vec2& x : state_.particles.position) x *= factor;
}

Health Engine::health() const {
  const Particles& p = state_.particles;
  Health h;
  double unbalance = 0, normal = 0;
  std::size_t free = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.boundary[i]) continue;
    unbalance += work_.forces.force[i].norm();
    ++free;
  }
  for (const Contact& c : state_.contacts) normal += c.normal_force;
  if (free > 0 && normal > 0) {
    const double contacts = static_cast<double>(state_.contacts.size());
    h.unbalanced_force = (unbalance / static_cast<double>(free)) / (normal / contacts);
    h.sliding_fraction = static_cast<double>(work_.sliding) / contacts;
  }
  return h;
}

}  // namespace dem
