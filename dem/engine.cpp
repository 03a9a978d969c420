#include "dem/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "dem/effects/contact_damping.hpp"
#include "dem/effects/gravity.hpp"
#include "dem/effects/local_damping.hpp"
#include "dem/effects/mass_scaling.hpp"

namespace dem {
namespace {

/// A shear force this near to the Coulomb limit, relatively, is at it.
constexpr double kAtLimit = 1e-9;

}  // namespace

Engine::Engine(const common::Scene& scene, State state, int threads)
    : effects_(scene.effects),
      damping_(scene.damping.local),
      safety_(scene.time_step.safety),
      gravity_(scene.gravity.acceleration),
      mass_share_(scene.mass_scaling.smallest_mass),
      team_(std::make_unique<Team>(threads)),
      constants_(contact_constants(scene)),
      kernel_(select_contact_kernel(scene.contact.law, scene.effects)),
      neighbours_(scene.neighbours.skin * scene.assembly.diameter_min),
      state_(std::move(state)) {
  stored_ = true;
  restart();
}

const State& Engine::state() const {
  if (!stored_) slots_.store(state_.contacts, constants_.tangential_stiffness);
  stored_ = true;
  return state_;
}

State& Engine::edit() {
  state();
  return state_;
}

void Engine::restart() {
  state();
  check_outlines();
  if (effects_.mass_scaling) least_mass_ = least_inertial_mass(state_.particles, mass_share_);
  state_.time_step = stable_time_step();
  outlines_.reset(state_.particles);
  inverse_.reset(state_.particles, least_mass_);
  forces_.force.resize(state_.particles.size());
  forces_.moment.resize(state_.particles.size());
  team_->for_blocks(state_.particles.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    outlines_.place(state_.particles, first, last);
  });
  slots_ = {};
  rebuild();
  slots_.load_histories(state_.contacts);
  // No time passes here, so no work is done: what changes is booked by whoever changed it.
  now_ = evaluate(0);
  state();
}

void Engine::check_outlines() const {
  const Particles& p = state_.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.outline(i).size() <= std::size_t{common::kMaxParticleVertices}) continue;
    throw common::bad_input(fmt::format("particle {}: its outline has {} vertices, expected at most {}", p.id[i],
                                        p.outline(i).size(), common::kMaxParticleVertices));
  }
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
    mass = std::min(mass, std::max(p.mass[i], least_mass_));
  }
  double stiffness = kernel_.stiffness_bound(edge, constants_);
  if (effects_.friction) stiffness = std::max(stiffness, constants_.tangential_stiffness);
  if (effects_.rolling_resistance) stiffness = std::max(stiffness, 2 * constants_.rolling_stiffness);
  const double factor = effects_.contact_damping ? damped_step_factor(constants_.damping) : 1;
  return factor * safety_ * std::sqrt(mass / stiffness);
}

void Engine::rebuild() {
  neighbours_.rebuild(state_.particles, outlines_, pairs_);
  slots_.renew(pairs_, effects_);
  slots_of_.reset(state_.particles.size(), pairs_);
}

ContactSums Engine::evaluate(double dt) {
  stored_ = false;
  const ContactScene scene{state_.particles, outlines_, inverse_.mass, constants_, state_.friction, dt};
  const ContactSums sums = team_->sum_blocks(slots_.size(), contact_sums_, [&](std::size_t first, std::size_t last) {
    return kernel_.evaluate(scene, slots_, first, last);
  });
  team_->for_blocks(state_.particles.size(), [&](std::size_t, std::size_t first, std::size_t last) {
    slots_of_.gather(slots_.load, first, last, forces_);
    if (effects_.gravity) add_weights(state_.particles, gravity_, first, last, forces_);
  });
  return sums;
}

void Engine::step(const StrainRate& rate) {
  Particles& p = state_.particles;
  const double dt = state_.time_step;
  const bool ledger = effects_.energy_ledger;
  const MotionSums motion =
      team_->sum_blocks(p.size(), motion_sums_, [&](std::size_t first, std::size_t last) -> MotionSums {
        MotionSums sums;
        const bool weighs = effects_.gravity && ledger;
        if (weighs) sums.gravity_work = 0.5 * dt * power_of_weights(p, gravity_, first, last);
        if (effects_.local_damping) {
          sums.damping = apply_local_damping(p, inverse_, forces_, damping_, dt, ledger, first, last);
        }
        sums.boundary_work = advance(p, forces_, inverse_, rate, dt, ledger, first, last);
        if (weighs) sums.gravity_work += 0.5 * dt * power_of_weights(p, gravity_, first, last);
        sums.outdated = neighbours_.outdated(p, first, last);
        outlines_.place(p, first, last);
        return sums;
      });
  ++state_.step;
  state_.time += dt;
  if (motion.outdated) rebuild();
  now_ = evaluate(dt);
  contact_steps_ += now_.contacts;
  if (ledger) {
    state_.energy.boundary_work += motion.boundary_work;
    state_.energy.damping += motion.damping;
    state_.energy.gravity_work += motion.gravity_work;
    state_.energy.friction += now_.friction;
    state_.energy.contact_damping += now_.contact_damping;
    state_.energy.rolling += now_.rolling;
    state_.energy.contact_law_work += now_.contact_law_work;
  }
}

void Engine::scale_positions(const Vec2& factor) {
  Particles& p = state_.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.boundary[i]) p.position[i] = p.position[i].cwiseProduct(factor);
  }
}

Health Engine::health() const {
  const Particles& p = state_.particles;
  Health h;
  double unbalance = 0, normal = 0;
  std::size_t free = 0, sliding = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.boundary[i]) continue;
    unbalance += forces_.force[i].norm();
    ++free;
  }
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    if (!(slots_.overlap_area[k] > 0)) continue;
    normal += slots_.normal_force[k];
    if (!effects_.friction) continue;
    // Whoever reached the limit was set to it; a re-evaluation may move the limit by a rounding.
    const double limit = state_.friction * slots_.normal_force[k] / constants_.tangential_stiffness;
    sliding += std::abs(slots_.shear_displacement[k]) >= (1 - kAtLimit) * limit;
  }
  if (free > 0 && normal > 0) {
    const double contacts = static_cast<double>(now_.contacts);
    h.unbalanced_force = (unbalance / static_cast<double>(free)) / (normal / contacts);
    h.sliding_fraction = static_cast<double>(sliding) / contacts;
  }
  return h;
}

}  // namespace dem
