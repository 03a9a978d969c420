// From the results of a frame's particles to the datasets of its split.
#pragma once

#include <vector>

#include "common/io/split.hpp"
#include "xfem/particle_case.hpp"

namespace xfem {

/// Fills particles, broken, fragments, cracks, refusals and work of `split`, particles in the order of the frame and
/// fragments numbered from the frame's next_id. Fragments inherit the cracks that lie wholly on their side. What was
/// not analysed gets the status that says why, its virial stress and the cracks that it had; the results in `cases` are
/// completed accordingly.
void record(const common::Frame& frame, const std::vector<common::Rotation>& rotation,
            const common::BreakageOptions& options, std::vector<ParticleCase>& cases, common::Split& split);

}  // namespace xfem
