// Growth by fracture toughness: the tip of a crack that is long enough advances where the equivalent stress intensity
// reaches K_Ic, in the direction of the largest hoop stress (Erdogan & Sih 1963), at the angle t from the crack's line:
//   tan(t / 2) = -2 K_II / (K_I + sqrt(K_I^2 + 8 K_II^2)),
//   K_eq = cos^2(t / 2) (K_I cos(t / 2) - 3 K_II sin(t / 2)),   K_I at least 0: closed faces do not close further.
// Strength and toughness meet at Irwin's length (K_Ic / sigma_t)^2 / pi: the half length of a crack that grows when the
// stress around it is sigma_t. A shorter crack grows by strength, as does one whose stress intensity the mesh does not
// resolve, and one that slides more than it opens (K_I < |K_II|) in rock that fails at once with the start
// (growth.hpp).
#pragma once

#include "xfem/crack/growth.hpp"
#include "xfem/crack/stress_intensity.hpp"

namespace xfem {

struct TipDrive {
  double equivalent;  ///< K_eq, in the unit of K
  Vec2 direction;     ///< of the largest hoop stress, unit vector
};
TipDrive largest_hoop_stress(const StressIntensity& intensity);

/// True for a tension of more than half the tensile strength: toughness decides on cracks that open in such a field,
/// not on those that slide.
bool torn(const HoekBrown& rock, const Stress& stress);

/// A crack's half length, or all of it from a mouth, must be at least this many element sizes for its K to count: three
/// elements of a crack with two tips.
inline constexpr double kResolvedLength = 1.5;

/// What the tip of a crack is driven by; empty if strength decides, see above.
std::optional<TipDrive> tip_drive(const IntactModel& model, const GrowthRules& rules, const CrackedState& state,
                                  std::span<const Crack> cracks, int crack, int end);

}  // namespace xfem
