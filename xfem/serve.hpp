// From files to files: one frame solved, alone or as a resident service over a line protocol.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

#include "xfem/solve_frame.hpp"

namespace xfem {

/// Receives sentences for people (warnings, summaries).
using Notify = std::function<void(const std::string&)>;

/// What the work took, by phase.
struct Profile {
  PhaseSeconds seconds;
  PhaseCounts counts;
};

/// Reads frames and previous splits, solves, writes splits. Keeps the split that it wrote last in memory, and takes it
/// instead of the file as long as that file is still the one that it wrote.
class SplitService {
 public:
  SplitService(const common::Scene& scene, int threads, Notify notify);

  struct Answer {
    common::WrittenFile file;
    common::Split split;
    PhaseSeconds seconds;  ///< of the solver's phases, and of reading and writing
    PhaseCounts counts;
  };
  /// Solves the frame of one file and writes its split; particles that are refused are told, and each of them stands in
  /// a file of its own (refusal.hpp). Throws bad_input, io_failure.
  const Answer& solve(const std::filesystem::path& frame, const std::optional<std::filesystem::path>& previous,
                      const std::filesystem::path& out);

 private:
  /// What tells a file from any other that ever had its name.
  struct FileMark {
    std::uint64_t device = 0, inode = 0, bytes = 0;
    std::int64_t changed_seconds = 0, changed_nanoseconds = 0;
    bool operator==(const FileMark&) const = default;
  };
  static std::optional<FileMark> mark_of(const std::filesystem::path& path);

  FrameSolver solver_;
  common::Durability durability_;
  Notify notify_;
  Answer last_;
  std::optional<FileMark> last_mark_;  ///< of the file that holds last_.split; empty: none
};

/// Reads lines `solve FRAME PREVIOUS|- OUT` (paths without white space), answers each with `split OUT BYTES HASH`, or
/// with `error CODE TEXT`, and goes on; `done` is answered by `done` and ends, so does the end of the input.
/// Returns seconds and counts, summed over the answers.
Profile serve(SplitService& service, std::istream& in, std::ostream& out);

/// One line for people: particles by status, growth steps.
std::string summary_line(const common::Split& split);

}  // namespace xfem
