// DIR/failure: what a run that a guard has stopped leaves, so that the failure can be seen again alone.
//
//   failure.json   reason, stage, frame, step, particles, numbers, program; written last: without it there is no
//   failure case.yaml, frames/ or prepared/, splits/
//                  a run directory that holds the newest checkpoint of the run and the split that was applied to it:
//                  `dem run DIR/failure/case.yaml --out DIR/failure --resume` stops at the same step for the same
//                  reason
//   state.h5       the state that was refused, as a frame (missing if it holds what is no number)
//
// From a frame, and not from a state in memory nearer to the failure: a run that goes on from a frame takes the very
// bits of the one that was not interrupted, so that the failure comes again to the last bit; and it is a frame's
// interval away, seconds of work.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/config/scene.hpp"
#include "dem/guards.hpp"

namespace dem {

struct Failure {
  Finding finding;
  std::string stage;
  std::int64_t frame = 0;  ///< that was to come
  std::int64_t step = 0;
  double time = 0;  ///< [s]
  double axial_strain = 0;
  std::filesystem::path checkpoint;  ///< newest file that the run can go on from; empty: its very start
  std::filesystem::path split;       ///< applied to it; empty: none
};

/// True if `directory` is what a failed run has left.
bool is_failure(const std::filesystem::path& directory);

/// Writes DIR/failure in place of an older one. `state` is written as far as it is valid. Throws io_failure.
void write_failure(const std::filesystem::path& directory, const common::Scene& scene, const Failure& failure,
                   common::Frame state);

/// True if xfem has refused a particle: the finding is of a split, so of the frame before the one to come.
bool is_refusal(const Failure& failure);

/// Frame or stage, step and strain, then what the guard has found.
std::string place_and_reason(const Failure& failure);

/// Calls write_failure and returns the lines that go below the reason: the command that fails again alone (for a
/// refused particle, if xfem has left its file, that of the particle), and how the run can go on. Says so if nothing
/// could be written.
std::string keep_and_advise(const std::filesystem::path& directory, const common::Scene& scene, const Failure& failure,
                            common::Frame state);

/// Removes it again. Files of others in that folder stay.
void remove_failure(const std::filesystem::path& directory);

}  // namespace dem
