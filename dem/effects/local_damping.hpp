// Cundall's local (non-viscous) damping: every component of the resultant is reduced by alpha |F| against the motion.
// Cundall 1987; Itasca PFC manual. Quasi-static states are reached without a velocity-dependent stress.
#pragma once

#include "dem/motion.hpp"

namespace dem {

/// Changes the resultants of the free particles among first..last-1 in place. With `ledger`, returns the energy that
/// the coming step of dt [s] takes out [J], otherwise 0.
double apply_local_damping(const Particles& particles, const InverseInertia& inverse, BodyForces& forces, double alpha,
                           double dt, bool ledger, std::size_t first, std::size_t last);

}  // namespace dem
