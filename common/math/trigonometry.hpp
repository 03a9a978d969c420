// Sine and cosine whose bits do not depend on the machine.
// The C library picks its kernels by CPU at run time, which would make a run's bytes depend on the host.
#pragma once

namespace common {

struct SinCos {
  double sin;
  double cos;
};

/// Sine and cosine of `angle` [rad], |angle| <= 1e6, to 2 units in the last place of 1.
/// Cody-Waite reduction by pi/2 in three parts, then Taylor polynomials on [-pi/4, pi/4].
/// Beyond that range, and for an angle that is not finite, both are NaN: a particle that spins so fast is an error.
SinCos sin_cos(double angle);

}  // namespace common
