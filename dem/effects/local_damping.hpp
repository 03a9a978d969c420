// Cundall's local (non-viscous) damping: every component of the resultant is reduced by alpha |F| against the motion.
// Cundall 1987; Itasca PFC manual. Quasi-static states are reached without a velocity-dependent stress.
#pragma once

#include "dem/contact/forces.hpp"
#include "dem/state.hpp"

namespace dem {

/// Changes the resultants of the free particles in place; with `ledger`, adds the energy taken out to state.energy.
void apply_local_damping(State& state, BodyForces& forces, double alpha, bool ledger);

}  // namespace dem
