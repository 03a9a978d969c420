// `--profile FILE.json`: seconds and counts per phase, so that this half can be profiled alone.
#pragma once

#include <filesystem>
#include <string>

#include "xfem/solve_frame.hpp"

namespace xfem {

/// What write_profile writes, as an event on one line: {"event": "profile", ...}.
std::string profile_event(const PhaseSeconds& seconds, const PhaseCounts& counts);

/// Writes {"seconds": {phase: s}, "counts": {name: n}}. Throws io_failure.
void write_profile(const std::filesystem::path& file, const PhaseSeconds& seconds, const PhaseCounts& counts);

}  // namespace xfem
