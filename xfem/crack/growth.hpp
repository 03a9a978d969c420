// Where a crack starts and how its tips go on, one element per step.
//
// Start: along the failure plane through the centroid of the element with the smallest load factor.
// Tip rule: a tip advances if any uncut element that shares a node of the tip edge and lies ahead of the tip fails;
// the direction comes from the area-weighted mean stress of these elements. Of the two conjugate shear planes the one
// nearest to the previous chord is taken, and the kink against the chord over the last h is at most 45 degrees.
// Failed at once: where the uncracked particle under the same load is within 10 % of failure too, the rock ahead broke
// together with the rock at the start, before a crack could turn the stress; there the direction is the failure plane
// of that field. Without this a shear fracture does not stay on its plane: its faces slide, its tips go into tension
// and turn towards the load, the sooner the finer the mesh. Whether a tip advances is still asked of the current field.
// Ligament rule: an advancing tip within `ligament` of the boundary along its ray goes straight through.
// `literal` is the reading of Raisianzadeh et al. 2019, section 2.2: only the element across the tip edge counts, any
// kink, no ligament rule.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "xfem/crack/path.hpp"
#include "xfem/criterion/hoek_brown.hpp"

namespace xfem {

struct GrowthRules {
  HoekBrown rock;
  double ligament = 0;  ///< [m]
  bool literal = false;
  /// Averaged stress of each element of the uncracked particle under the same load; empty: nothing fails at once.
  std::span<const Stress> uncracked = {};
  double toughness = 0;  ///< K_Ic [Pa sqrt(m)], in the unit of length of the mesh; 0: none declared, see toughness.hpp
};

/// What has a load factor of at most this in the uncracked particle fails at once with the start. Rock strength
/// scatters by more than 10 % within one specimen; without a margin a field uniform to 0.1 % would not count as one.
inline constexpr double kFailsAtOnce = 1.1;

/// True if an element fails at once with the start.
bool fails_at_once(const GrowthRules& rules, int element);

/// Load factor at failure of a stress state.
double load_factor(const HoekBrown& rock, const Stress& stress);

/// A crack seen from one end, 0 or 1: its tip is the last point.
Crack oriented(const Crack& crack, int end);

/// Unit vector of the chord over at least `length` up to the last point, or over the whole crack.
Vec2 tip_direction(const Crack& crack, double length);

/// For each element the index of the crack that cuts it (the lowest), -1: none.
std::vector<int> cutting_cracks(const Mesh& mesh, std::span<const Crack> cracks);

/// The element that a tip would enter, `end` 0 or 1; -1 at the boundary.
int element_ahead(const Mesh& mesh, const Crack& crack, int end);

/// A crack through one element. Of two conjugate shear planes the one whose neighbouring elements along the plane are
/// nearer to failure (larger sum of 1 / lambda; the boundary counts 0), the first on ties. Empty if both exits are on
/// the boundary: that would only cut off a corner.
std::optional<Crack> start_crack(const Mesh& mesh, const GrowthRules& rules, std::span<const Stress> stress,
                                 int element);

enum class TipOutcome {
  stays,     ///< nothing ahead fails
  grown,     ///< by one element
  through,   ///< reached the boundary
  merged,    ///< the element ahead is cut by another crack
  arrested,  ///< for good: no valid way on
};

struct TipStep {
  TipOutcome outcome = TipOutcome::stays;
  Crack crack;     ///< after the step
  Crack fallback;  ///< through, merged: the crack up to the last tip inside, arrested there, if the path is a chip
};

/// Smallest load factor of the elements that decide on an active tip by strength; 0 if the tip ends here without one.
double tip_load_factor(const Mesh& mesh, const GrowthRules& rules, std::span<const Stress> stress,
                       std::span<const int> cutting, const Crack& crack, int end);

/// True if the ligament rule could hold for a tip that goes straight on by one element.
bool at_ligament(const Mesh& mesh, PolygonView outline, const GrowthRules& rules, const Crack& crack, int end);

/// What toughness says of a tip.
struct DrivenTip {
  bool advances;
  Vec2 direction;  ///< unit vector
};

/// One step of an active tip. `stress`: element stresses of the current cracked state; `cutting`: cutting_cracks;
/// `driven`: what decides in place of the strength ahead of the tip, see toughness.hpp; at the ligament such a tip goes
/// straight on.
TipStep advance_tip(const Mesh& mesh, PolygonView outline, const GrowthRules& rules, std::span<const Stress> stress,
                    std::span<const int> cutting, std::span<const Crack> cracks, int crack, int end,
                    const std::optional<DrivenTip>& driven = std::nullopt);

}  // namespace xfem
