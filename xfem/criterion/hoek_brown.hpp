// Hoek-Brown failure of intact rock as a load factor: by how much must the load grow until this stress fails.
// Hoek & Brown 1997; Eqs. 4-6 of Raisianzadeh et al. 2019. Compression positive, in-plane principal stresses.
#pragma once

#include "common/geometry/vec2.hpp"
#include "common/io/split.hpp"

namespace xfem {

using common::FailureMode;
using common::Vec2;

/// Plane stress tensor, compression positive [Pa].
struct Stress {
  double xx = 0, yy = 0, xy = 0;
};

struct PrincipalStress {
  double s1 = 0, s3 = 0;  ///< major and minor [Pa], s1 >= s3
  Vec2 direction1{1, 0};  ///< unit vector of s1; (1, 0) for a hydrostatic state
};
PrincipalStress principal(const Stress& stress);

struct HoekBrown {
  double sigma_ci;  ///< uniaxial compressive strength [Pa]
  double m_i;       ///< [-]

  double tensile_strength() const { return sigma_ci / m_i; }
  /// Eq. 4: s1 at failure for a given s3 >= -sigma_ci / m_i [Pa].
  double strength(double s3) const;
  /// Load factor lambda > 0 at which lambda * (s1, s3) reaches the envelope; +infinity if it never does.
  /// The closed forms of DESIGN section 3, in the branch that does not cancel.
  double load_factor(double s1, double s3) const;
  /// Tensile where s3 < 0 and s1 <= t |s3|, t = m + 1 - 2 sqrt(m + 1) (Fairhurst's tangent point; never for m <= 3).
  FailureMode mode(double s1, double s3) const;
  /// The two conjugate failure planes (unit vectors along the planes) of a stress state at failure.
  /// Tension: both equal, along s1. Shear: at pi/4 - phi/2 on either side of s1, phi from the slope of the envelope
  /// at lambda * s3.
  struct Planes {
    Vec2 first, second;
    FailureMode mode;
  };
  Planes planes(const PrincipalStress& stress) const;
};

}  // namespace xfem
