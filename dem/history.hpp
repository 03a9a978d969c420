// The rows of history/*: what the assembly does as a whole, recorded every few steps and at every frame.
#pragma once

#include <vector>

#include "common/io/frame.hpp"
#include "dem/stages/control.hpp"

namespace dem {

class History {
 public:
  explicit History(const common::Scene& scene);

  /// Measures the present state and appends a row. Throws numerical_failure if a measure is not finite.
  void record(const Engine& engine, const Control& control);

  /// The rows since the last call.
  std::vector<common::Column> take();

 private:
  const common::Scene& scene_;
  std::vector<common::Column> columns_;
};

/// Stops a run whose integration has failed: past the stable time step stresses stay plausible while particles rattle.
/// Judges the rows since the last frame of the shear stage. Throws numerical_failure if
/// - with local damping and slow loading (inertial number below 0.01) the unbalanced force never fell below 0.03: its
///   smallest value between two frames is below 0.002 in sound runs at 0.02 /s (100 particles or more, four laws),
///   0.021 at 0.2 /s, above 0.037 in ones whose time step or servo is unstable, or
/// - with the ledger |energy_residual| is above 5 % of boundary work and stored energy: sound ones stay below 0.5 %.
void require_sound(const common::Scene& scene, const std::vector<common::Column>& history);

/// Boundary work less all that it went into [J]; 0 for a ledger that closes.
double energy_residual(const Engine& engine, const Control& control);

}  // namespace dem
