// Stress intensity factors of a crack tip from the energy that the XFEM field would release, by the interaction
// integral in its domain form (Shih, Moran & Nakamura 1986; Shih & Asaro 1988), tension positive:
//   K = E' / 2 [ integral of (s_ij u'_i,1 + s'_ij u_i,1 - s_kl e'_kl delta_1j) q,j dA - sum over faces of
//                integral of t_i u'_i,1 q dx ],
// s, u the field; s', e', u' the near-tip field of K_I = 1 or K_II = 1; x_1 along the crack, x_2 to its left; q a
// weight that is 1 at the tip and 0 outside a ring; t the traction of a closed face. E' = E / (1 - nu^2) in plane
// strain, E in plane stress. Stress and strain are constant in an uncut T3 and in each part of a cut one, so only s',
// u' need integration points: three in each triangle.
#pragma once

#include <optional>

#include "xfem/crack/cracked_solver.hpp"

namespace xfem {

struct StressIntensity {
  double one = 0;   ///< K_I [Pa sqrt(m)], positive: opens
  double two = 0;   ///< K_II [Pa sqrt(m)], positive: the left side slides forward, so that the crack turns right
  Vec2 axis{1, 0};  ///< x_1, unit vector
};

/// The weight is 1 up to the first of these distances from the tip and 0 from the second on, in element sizes there.
inline constexpr double kRingInside = 1, kRingOutside = 2;

/// Mean element size around a tip [m]: edge of the equilateral triangle of the mean area.
double element_size(const Mesh& mesh, const CrackPoint& tip);

/// K of a tip, `end` 0 or 1, in the unit of the mesh; K_I is 0 where the faces next to the tip are closed. The weight
/// keeps off the boundary, the other cracks and the crack's other tip; empty if they are so near that no ring is left.
std::optional<StressIntensity> stress_intensity(const IntactModel& model, const CrackedState& state,
                                                std::span<const Crack> cracks, int crack, int end);

}  // namespace xfem
