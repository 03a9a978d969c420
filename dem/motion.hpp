// Newton's second law by leapfrog: v(t + dt/2) = v(t - dt/2) + F(t)/m dt, x(t + dt) = x(t) + v(t + dt/2) dt.
#pragma once

#include "dem/contact/forces.hpp"
#include "dem/state.hpp"

namespace dem {

/// Rates at which the boundary moves, v = -(rate_xx x, rate_yy y): compression positive [1/s].
struct StrainRate {
  double xx = 0, yy = 0;
};

/// What resists acceleration, inverted once: N each.
struct InverseInertia {
  std::vector<double> mass;    ///< [1/kg]
  std::vector<double> moment;  ///< [1/(kg m^2)]

  /// A particle lighter than `least_mass` [kg] moves as if it had that mass (effects/mass_scaling.hpp).
  void reset(const Particles& particles, double least_mass);
};

/// Advances particles first..last-1 by dt [s]: free ones by their forces, boundary particles by the strain rate
/// (without turning); accumulates displacements. With `ledger`, returns the work of the boundary [J], otherwise 0.
double advance(Particles& particles, const BodyForces& forces, const InverseInertia& inverse, const StrainRate& rate,
               double dt, bool ledger, std::size_t first, std::size_t last);

/// Kinetic energy of the free particles [J], at the instant of the velocities, of the masses that they move with.
double kinetic_energy(const Particles& particles, double least_mass = 0);

}  // namespace dem
