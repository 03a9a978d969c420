// A split applied to the assembly: broken particles give way to their fragments.
//
// The caller settles the contact history in three moves:
//   SplitReport report = apply_split(engine.edit(), split, density);
//   engine.restart();                                   // which heirs overlap, and their normal forces
//   share_inherited_history(engine.edit(), report);
//   engine.restart();                                   // shear forces of the shares, within the Coulomb limit
#pragma once

#include "common/io/split.hpp"
#include "dem/state.hpp"

namespace dem {

/// A contact that a fragment may inherit from its parent; indices after the split, a < b. Heirs of one contact have
/// the same `group`.
struct InheritedContact {
  std::int32_t a = 0, b = 0;
  std::int32_t group = 0;
  double shear_displacement = 0;  ///< of the parent's contact [m]
};

struct SplitReport {
  int broken = 0;
  double momentum_error = 0;                ///< |change of total linear momentum| / sum of m |v|, rounding only
  double kinetic_energy_change = 0;         ///< [J]; rounding only
  double area_error = 0;                    ///< |change of total solid area| / total
  std::vector<InheritedContact> inherited;  ///< groups in the order of the parents' contacts
};

/// Replaces each broken particle of `split` by its two fragments (arrays stay ascending by id; fragments stand last).
/// A fragment takes the parent's rigid motion v + omega x r at its centroid, so that mass, linear and angular momentum
/// and kinetic energy are conserved; root, displacement and angle of the parent, generation + 1, type -1, never the
/// boundary flag. Its body frame has its centroid (common::centroid of the vertices in the parent's frame) as origin.
/// `state.contacts` are re-indexed; a contact of a parent stays in the list once for each fragment that may inherit it,
/// with its shear_displacement, so that the next evaluation finds the history (pairs that do not overlap drop out
/// there). Ring and next_id follow.
/// Throws bad_input if the split names unknown or boundary particles, ids that are taken, or fragments that do not fill
/// the parent (two for each, areas within 1e-9); the state is then unchanged.
SplitReport apply_split(State& state, const common::Split& split, double density);

/// After an evaluation of the contacts (dt = 0): of the heirs of one contact that overlap, each takes its share of the
/// parent's shear displacement, in proportion to the normal forces. With equal tangential stiffness the sum of the
/// shear forces is then that of the parent, unless the Coulomb limit of a heir is lower. Without this, two heirs would
/// carry the whole shear force each.
void share_inherited_history(State& state, const SplitReport& report);

}  // namespace dem
