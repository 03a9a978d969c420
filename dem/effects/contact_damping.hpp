// Viscous damping of a contact's normal motion, a dashpot beside the spring (Cundall & Strack 1979):
//
//   F_v = -c v_n,  c = 2 beta sqrt(k m),  1/m = 1/m_a + 1/m_b,  N = max(0, F_e + F_v)
//
// v_n: velocity of b relative to a along the normal [m/s]; F_e: force of the normal law [N]; k: its slope at the
// present width [N/m]; beta: share of critical, damping.contact; a boundary particle has infinite mass. Contacts never
// attract: what F_v would pull is cut off (Schwager & Poeschel 2007). Coulomb's limit is that of the total N.
//
// The dashpot sees the velocity half a step late, so dt shrinks by sqrt(1 + beta^2) - beta (Belytschko 1983).
#pragma once

#include <algorithm>
#include <cmath>

namespace dem {

/// F_v after the cut [N]; `inverse_mass` = 1/m [1/kg].
inline double viscous_force(double elastic_force, double stiffness, double ratio, double inverse_mass,
                            double normal_velocity) {
  return std::max(-2 * ratio * std::sqrt(stiffness / inverse_mass) * normal_velocity, -elastic_force);
}

/// Factor on the time step.
inline double damped_step_factor(double ratio) {
  return std::sqrt(1 + ratio * ratio) - ratio;
}

}  // namespace dem
