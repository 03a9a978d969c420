// Rolling resistance: an elastic-plastic rotational spring in the contact (type C of Ai, Chen, Rotter & Ooi 2011,
// Powder Technology 206, 269-282, without its dashpot; Iwashita & Oda 1998):
//
//   M += -k_r (omega_b - omega_a) dt,  |M| <= mu_r R N,  1/R = 1/R_a + 1/R_b,  R_i = sqrt(A_i / pi)
//   k_r = 3 k (mu_r R)^2
//
// M: moment on b, -M on a [N m]; mu_r: contact.rolling_friction; k: normal stiffness [N/m], for the laws with a
// stiffness per area their slope at a contact a fifth of a mean diameter wide. The factor 3 is that of a contact face
// of width w = 6 mu_r R: an even bed of springs k / w tilts with k w^2 / 12 and parts at its edge at M = N w / 6 = mu_r
// R N.
#pragma once

#include <algorithm>
#include <cmath>

namespace dem {

/// k_r / R^2 [N/m]. No rotation is stiffer than 2 of it over the particle's mass, since R <= R_i and I >= m R_i^2 / 2.
inline double rolling_stiffness(double normal_stiffness, double rolling_friction) {
  return 3 * normal_stiffness * rolling_friction * rolling_friction;
}

/// R [m] of two particles of these areas [m^2].
inline double rolling_radius(double area_a, double area_b) {
  constexpr double kInversePi = 0.3183098861837907;
  const double a = std::sqrt(area_a * kInversePi);
  const double b = std::sqrt(area_b * kInversePi);
  return a * b / (a + b);
}

/// The moment on b after a relative rotation of b [rad]; `stiffness` is k_r [N m], `limit` mu_r R N [N m].
inline double rolling_moment(double before, double rotation, double stiffness, double limit) {
  return std::clamp(before - stiffness * rotation, -limit, limit);
}

}  // namespace dem
