// Measures of an assembly: ring polygon, void ratios, stress.
#pragma once

#include <array>

#include "dem/state.hpp"

namespace dem {

/// Area of the polygon that joins the ring centroids [m^2].
double ring_area(const State& state);

/// The three void ratios (DESIGN section 2, Preparation). Particles that have left the assembly, outside the ring and
/// touching nothing, count in none.
struct VoidRatios {
  double e1 = 0;    ///< ring polygon / solids inside it - 1, boundary particles counted by interior angle / (2 pi)
  double e2 = 0;    ///< e1 with the overlaps subtracted from the solids
  double e4 = 0;    ///< ring polygon / area of the particles that are not in the ring - 1
  int escaped = 0;  ///< particles that have left the assembly
};
VoidRatios void_ratios(const State& state);

/// Mean stress (xx, yy, xy), compression positive [Pa], Eq. 13: (1/A) sum f_i l_j over the contacts in force, branch
/// vectors between centroids, A the ring polygon.
std::array<double, 3> mean_stress(const State& state, double assembly_area);

/// Mean stress of the interior (xx, yy, xy), compression positive [Pa]: the average over an ellipse about the middle of
/// the ring, with 0.7 of its axes. Each contact counts with the share of its branch vector inside: (1/A) sum f_i l_j s,
/// which is the exact average of the stress field along the branches of an assembly at rest (Noll 1955; Hardy 1982).
std::array<double, 3> interior_stress(const State& state, double assembly_area);

}  // namespace dem
