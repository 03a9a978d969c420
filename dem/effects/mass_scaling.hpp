// Mass scaling: the smallest fragments, which alone would set the time step, move as if they were heavier. Forces at
// rest do not feel it. (Selective mass scaling of explicit finite elements: Olovsson, Simonsson & Unosson 2005; density
// scaling in DEM: Cundall 1982.)
//
//   m' = max(m, f M),  I' = I m' / m,   M: mean mass of the original particles, f = mass_scaling.smallest_mass
//
// I grows with m, so that no rotation becomes the stiffest motion instead. Weights, momenta at splits and frames keep
// the true mass; the equations of motion, the time step and the kinetic energy of the ledger use m' and I'. There is no
// array: M is a function of masses and roots.
#pragma once

#include "dem/state.hpp"

namespace dem {

/// f M above [kg]; `share` is f.
double least_inertial_mass(const Particles& particles, double share);

/// What mass scaling does at present, for the history.
struct MassScaling {
  double particles = 0;   ///< number that move with a raised mass
  double added_mass = 0;  ///< sum of m' / sum of m - 1
};
MassScaling mass_scaling(const Particles& particles, double least_mass);

}  // namespace dem
