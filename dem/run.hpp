// `dem run`: preparation and shear with frames, checkpoints and pauses for the breakage analysis.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/config/scene.hpp"
#include "common/io/immutable_file.hpp"

namespace dem {

struct RunOptions {
  std::filesystem::path directory;
  bool resume = false;
  std::optional<std::int64_t> until_frame;
  std::filesystem::path profile;  ///< seconds and counts per phase as JSON; empty: none
  int threads = 1;
};

/// What `run` tells and asks its surroundings; a run is silent without.
struct RunPorts {
  /// Progress for people or for the driver: one JSON object without newline.
  std::function<void(const std::string&)> progress = [](const std::string&) {};
  /// Resident mode: a frame has been written; returns the path of its split, empty for "no split", or nothing to stop.
  std::function<std::optional<std::string>(std::int64_t frame, const common::WrittenFile&)> exchange;
  /// True when the process has been asked to end.
  std::function<bool()> interrupted = [] { return false; };
};

enum class RunEnd {
  finished,  ///< the last frame of the test is written
  paused,    ///< at a frame: `until_frame`, or a split is needed
  stopped,   ///< told to stop
  interrupted,
};

/// Runs a scene in a directory (INTERFACES: dem run, Resume, Serve). Throws common::Error.
RunEnd run(const common::Scene& scene, const RunOptions& options, const RunPorts& ports);

}  // namespace dem
