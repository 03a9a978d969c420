// A sample that another run has prepared, as the start of this one (preparation.from).
#pragma once

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"

namespace dem {

/// Reads scene.preparation.from: a prepared sample, or frame 0 of a test. Throws bad_input for any other frame, for a
/// checkpoint from the middle of a preparation, and if the particles' density is not that of the scene.
common::Frame read_sample(const common::Scene& scene);

}  // namespace dem
