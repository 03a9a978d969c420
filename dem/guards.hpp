// What stops a run that went wrong, before its results look plausible.
#pragma once

#include <vector>

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"

namespace dem {

/// Stops a run whose integration has failed: past the stable time step stresses stay plausible while particles rattle.
/// Judges the rows since the last frame of the shear stage. Throws numerical_failure if
/// - with local damping and slow loading (inertial number below 0.01) the unbalanced force never fell below 0.03: its
///   smallest value between two frames is below 0.002 in sound runs at 0.02 /s (100 particles or more, four laws),
///   0.021 at 0.2 /s, above 0.037 in ones whose time step or servo is unstable, or
/// - with the ledger |energy_residual| is above 5 % of boundary work and stored energy: sound ones stay below 0.5 %.
void require_sound(const common::Scene& scene, const std::vector<common::Column>& history);

}  // namespace dem
