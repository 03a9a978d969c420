#include "dem/effects/local_damping.hpp"

#include <cmath>

namespace dem {
namespace {

struct Damped {
  double force;
  double dissipated;
};

// One component: force [N] or moment [N m], velocity at t - dt/2, inverse inertia. The work uses the mean of the
// velocities before and after the step, as the kinetic energy does.
Damped damp(double force, double velocity, double inverse_inertia, double alpha, double dt) {
  if (velocity == 0) return {force, 0};
  const double drag = -alpha * std::abs(force) * std::copysign(1.0, velocity);
  const double damped = force + drag;
  const double mean_velocity = velocity + 0.5 * damped * inverse_inertia * dt;
  return {damped, -drag * mean_velocity * dt};
}

}  // namespace

void apply_local_damping(State& state, BodyForces& forces, double alpha, bool ledger) {
  const Particles& p = state.particles;
  double dissipated = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.boundary[i]) continue;
    for (int k = 0; k < 2; ++k) {
      const Damped d = damp(forces.force[i][k], p.velocity[i][k], 1 / p.mass[i], alpha, state.time_step);
      forces.force[i][k] = d.force;
      dissipated += d.dissipated;
    }
    const Damped d = damp(forces.moment[i], p.angular_velocity[i], 1 / p.inertia[i], alpha, state.time_step);
    forces.moment[i] = d.force;
    dissipated += d.dissipated;
  }
  if (ledger) state.energy.damping += dissipated;
}

}  // namespace dem
