// The breakage analysis of a whole contact state: a pure function of (frame, previous split, scene).
#pragma once

#include <map>
#include <memory>

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "xfem/breakage.hpp"

namespace xfem {

/// Seconds by phase; never part of a payload.
using PhaseSeconds = std::map<std::string, double>;

/// Analyses frames and keeps the particles' models (mesh, factor) between them. What it keeps is a cache: the result
/// does not depend on what was solved before.
class FrameSolver {
 public:
  FrameSolver(const common::Scene& scene, int threads);
  ~FrameSolver();

  /// Throws bad_input if `previous` does not belong to the scene or the frame's particles.
  common::Split solve(const common::Frame& frame, const common::Split* previous);

  const PhaseSeconds& seconds() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace xfem
