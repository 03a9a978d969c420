// Stress control: a PI law that turns the stress error into a strain rate of the boundary.
//
//   rate = kp (p - sigma) + integral,  d integral/dt = ki (p - sigma),  |rate| <= max_rate
// With K the modulus that the gains refer to and tau = R / c the time a stress wave takes from the ring to the centre,
// c = sqrt(K / density):
//   kp = 2.4 / (K tau),  ki = kp / (0.75 tau).
// Proportional control alone leaves an offset, since the lateral strain rate of a shearing sample is not zero. The mean
// stress follows the rate like an integrator, without dead time (a boundary that speeds up strains the layer next to it
// at once), so that the gain may exceed 1 / (K tau); twice these gains were still stable in samples three to four times
// stiffer than K = 1e8 Pa. A dense sample dilates: at its peak it expands sideways at up to twice the axial rate, which
// the limit of the rate must allow, or the stress is lost.
//
// The stress is measured every `servo_interval` steps. Between two measurements the error of a sample of modulus M
// changes by kp M interval of itself: swings that do not die out beyond 2, which large steps in a small sample come to.
#pragma once

#include "common/config/scene.hpp"

namespace dem {

struct ServoGains {
  double proportional;  ///< kp [1/(Pa s)]
  double integral;      ///< ki [1/(Pa s^2)]
  double max_rate;      ///< [1/s]
  double wave_time;     ///< tau [s]
};

/// One controlled direction.
struct Servo {
  double integral = 0;  ///< [1/s]
  double rate = 0;      ///< strain rate in force, compression positive [1/s]

  /// Takes in a stress measured `dt` after the last one [Pa, s]. The integral stops growing while the rate is at its
  /// limit.
  void update(const ServoGains& gains, double target, double measured, double dt);
};

/// Gains for a sample of radius `radius` [m] and bulk density `density` [kg/m^3] held at `pressure` [Pa] while it is
/// strained at `drive_rate` [1/s] in the other direction. Without a limit in the options the rate may reach the larger
/// of 0.1 pressure / (K tau) and three times the drive's.
ServoGains servo_gains(const common::ServoOptions& options, double pressure, double radius, double density,
                       double drive_rate);

/// Steps of `time_step` [s] between two measurements: ten, or so many fewer that they take at most a tenth of tau, with
/// which the error of a sample four times as stiff as K changes at most by itself.
int servo_interval(const ServoGains& gains, double time_step);

}  // namespace dem
