// Pairs of real packings: contacts and near misses, step after step, every pair with its own cached feature.
#pragma once

#include <filesystem>
#include <optional>

#include "dem/engine.hpp"
#include "tests/robustness/geometry/check.hpp"

namespace differential {

struct HarvestOptions {
  std::int64_t pairs = 0;  ///< stop when so many were checked
  int steps = 400;         ///< most steps from a frame
  int every = 10;          ///< check at each so many steps
  bool world = false;      ///< coordinates as the engine has them, not relative to the first particle of the pair
  std::int64_t exact_stride = 0;  ///< each so many pairs in exact arithmetic; 0: none
};

/// Steps the engine with the boundary moving as in shear and checks all pairs whose circles are within the engine's
/// skin. `source` becomes the first number of the case keys.
void harvest(dem::Engine& engine, const common::Scene& scene, std::int64_t source, const HarvestOptions& options,
             Kernel kernel, Tally& tally);

/// The engine at a frame of a run directory; the frame's split, if there is one, has been applied.
dem::Engine engine_at(const std::filesystem::path& frame, const common::Scene& scene);

/// The pair of a case key, found by the same steps; `key[0]` does not count. Empty if it never is a candidate.
std::optional<Sample> harvested_sample(dem::Engine& engine, const common::Scene& scene, const CaseKey& key,
                                       const HarvestOptions& options, Kernel kernel);

}  // namespace differential
