// Newton's second law by leapfrog: v(t + dt/2) = v(t - dt/2) + F(t)/m dt, x(t + dt) = x(t) + v(t + dt/2) dt.
#pragma once

#include "dem/contact/forces.hpp"
#include "dem/state.hpp"

namespace dem {

/// Rates at which the boundary moves, v = -(rate_xx x, rate_yy y): compression positive [1/s].
struct StrainRate {
  double xx = 0, yy = 0;
};

/// Advances free particles by their forces and boundary particles by the strain rate (without turning), and
/// accumulates displacements. With `ledger`, adds the work of the boundary to state.energy.
void advance(State& state, const BodyForces& forces, const StrainRate& rate, bool ledger);

/// Writes the world outlines of the present positions.
void transform_outlines(const Particles& particles, std::vector<Vec2>& world);

/// Kinetic energy of the free particles [J], at the instant of the velocities.
double kinetic_energy(const Particles& particles);

}  // namespace dem
