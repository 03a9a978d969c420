// Stress control: a PI law that turns the stress error into a strain rate of the boundary.
//
//   rate = kp (p - sigma) + integral,  d integral/dt = ki (p - sigma),  |rate| <= max_rate
// With K the modulus that the gains refer to and tau = R / c the time a stress wave takes from the ring to the centre:
//   kp = 0.3 / (K tau),  ki = kp / (1.5 tau).
// Proportional control alone leaves an offset, since the lateral strain rate of a shearing sample is not zero.
#pragma once

#include "common/config/scene.hpp"

namespace dem {

struct ServoGains {
  double proportional;  ///< kp [1/(Pa s)]
  double integral;      ///< ki [1/(Pa s^2)]
  double max_rate;      ///< [1/s]
};

/// One controlled direction.
struct Servo {
  double integral = 0;  ///< [1/s]
  double rate = 0;      ///< strain rate in force, compression positive [1/s]

  /// Takes in a stress measured `dt` after the last one [Pa, s]. The integral stops growing while the rate is at its
  /// limit.
  void update(const ServoGains& gains, double target, double measured, double dt);
};

/// Gains for a sample of radius `radius` [m] and bulk density `density` [kg/m^3] held at `pressure` [Pa].
ServoGains servo_gains(const common::ServoOptions& options, double pressure, double radius, double density);

}  // namespace dem
