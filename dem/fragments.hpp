// A split applied to the assembly: broken particles give way to their fragments.
#pragma once

#include "common/io/split.hpp"
#include "dem/state.hpp"

namespace dem {

struct SplitReport {
  int broken = 0;
  double momentum_error = 0;         ///< |change of total linear momentum| / sum of m |v|, rounding only
  double kinetic_energy_change = 0;  ///< [J]
  double area_error = 0;             ///< |change of total solid area| / total
};

/// Replaces each broken particle of `split` by its two fragments (arrays stay ascending by id). A fragment takes the
/// parent's rigid motion v + omega x r at its centroid, root, generation + 1, type -1, displacement of its material
/// point, never the boundary flag. The body frame of a fragment: its centroid (common::centroid of the vertices in
/// the parent's frame) as origin, the parent's angle.
/// `state.contacts` are re-indexed; a contact of a parent stays in the list once for each fragment that may inherit it,
/// with its shear_displacement, so that the next evaluation finds the history (pairs that do not overlap drop out
/// there); the share is settled by `share_inherited_history` after that evaluation.
/// Throws bad_input if the split names unknown particles, ids that are taken or fragments that do not fill the parent.
SplitReport apply_split(State& state, const common::Split& split, double density);

}  // namespace dem
