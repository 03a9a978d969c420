// The breakage analysis of a whole contact state: a pure function of (frame, previous split, scene).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "xfem/breakage.hpp"

namespace xfem {

/// Seconds by phase; never part of a payload.
using PhaseSeconds = std::map<std::string, double>;

/// What one frame cost, for `--profile`: counters that may depend on what was cached.
using PhaseCounts = std::map<std::string, std::int64_t>;

/// The parameters of every particle's analysis, from the scene; of the effects toughness and face_friction count.
BreakageParameters breakage_parameters(const common::MaterialOptions& material, const common::BreakageOptions& options,
                                       const common::Effects& effects = {});
ElasticConstants elastic_constants(const common::MaterialOptions& material);

/// Analyses frames and keeps the particles' models (mesh, factor) between them. What it keeps is a cache: the result
/// does not depend on what was solved before.
class FrameSolver {
 public:
  /// `threads` 0: as many as there are processors.
  FrameSolver(const common::Scene& scene, int threads);
  ~FrameSolver();

  /// Throws bad_input if `previous` does not belong to the scene or the frame's particles.
  common::Split solve(const common::Frame& frame, const common::Split* previous);

  /// Of the last frame solved.
  const PhaseSeconds& seconds() const;
  const PhaseCounts& counts() const;
  /// Sentences for people about the last frame solved, for example on loads that are not balanced.
  const std::vector<std::string>& warnings() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace xfem
