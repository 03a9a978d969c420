// The rows of history/*: what the assembly does as a whole, recorded every few steps and at every frame.
#pragma once

#include <string>
#include <vector>

#include "common/io/frame.hpp"
#include "dem/stages/control.hpp"

namespace dem {

class History {
 public:
  explicit History(const common::Scene& scene);

  /// Measures the present state and appends a row. Throws numerical_failure if a measure is not finite.
  void record(const Engine& engine, const Control& control);

  /// Value of a column in the last row.
  double last(const std::string& name) const;

  /// The rows since the last call.
  std::vector<common::Column> take();

 private:
  const common::Scene& scene_;
  std::vector<common::Column> columns_;
};

/// Boundary work less all that it went into [J]; 0 for a ledger that closes.
double energy_residual(const Engine& engine, const Control& control);

}  // namespace dem
