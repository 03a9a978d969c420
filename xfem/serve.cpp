#include "xfem/serve.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <istream>
#include <ostream>
#include <sstream>
#include <vector>

#include "common/error.hpp"
#include "xfem/interrupts.hpp"
#include "xfem/refusal.hpp"

namespace xfem {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string error_line(common::ExitCode code, std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return fmt::format("error {} {}", static_cast<int>(code), text);
}

std::string answer_to(SplitService& service, const std::vector<std::string>& words, Profile& sums) {
  if (words.size() != 4 || words[0] != "solve")
    throw common::bad_input("serve: expected `solve FRAME PREVIOUS|- OUT` (paths without spaces) or `done`");
  std::optional<std::filesystem::path> previous;
  if (words[2] != "-") previous = words[2];
  const SplitService::Answer& answer = service.solve(words[1], previous, words[3]);
  for (const auto& [phase, seconds] : answer.seconds) sums.seconds[phase] += seconds;
  for (const auto& [name, count] : answer.counts) sums.counts[name] += count;
  return fmt::format("split {} {} {}", words[3], answer.file.bytes, answer.file.payload_hash);
}

}  // namespace

SplitService::SplitService(const common::Scene& scene, int threads, Notify notify)
    : solver_(scene, threads), durability_(scene.output.durability), notify_(std::move(notify)) {}

std::optional<SplitService::FileMark> SplitService::mark_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return FileMark{status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size), status.st_ctim.tv_sec,
                  status.st_ctim.tv_nsec};
}

const SplitService::Answer& SplitService::solve(const std::filesystem::path& frame_path,
                                                const std::optional<std::filesystem::path>& previous_path,
                                                const std::filesystem::path& out) {
  const auto start = std::chrono::steady_clock::now();
  const common::Frame frame = common::read_frame(frame_path, common::FrameContent::contact_state);
  common::Split previous;
  if (previous_path) {
    const bool in_memory = last_mark_ && mark_of(*previous_path) == last_mark_;
    previous = in_memory ? std::move(last_.split) : common::read_split(*previous_path);
  }
  last_mark_.reset();
  const double reading = seconds_since(start);

  common::Split split;
  try {
    split = solver_.solve(frame, previous_path ? &previous : nullptr);
  } catch (const common::Error& error) {
    throw common::Error(error.code(), fmt::format("{}: {}", frame_path.string(), error.what()));
  }
  for (const std::string& warning : solver_.warnings()) notify_("warning: " + warning);
  for (const std::string& refusal :
       keep_refusals(frame, previous_path ? &previous : nullptr, split, refusal_folder(out))) {
    notify_(refusal);
  }

  const auto write_start = std::chrono::steady_clock::now();
  {
    const NoInterruption writing;
    last_.file = common::write_split(out, split, durability_);
  }
  last_.split = std::move(split);
  last_mark_ = mark_of(out);
  last_.seconds = solver_.seconds();
  last_.seconds["read"] = reading;
  last_.seconds["write"] = seconds_since(write_start);
  last_.seconds["total"] = seconds_since(start);
  last_.counts = solver_.counts();
  return last_;
}

Profile serve(SplitService& service, std::istream& in, std::ostream& out) {
  Profile sums;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    const bool done = words.size() == 1 && words[0] == "done";
    try {
      out << (done ? "done" : answer_to(service, words, sums)) << std::endl;
    } catch (const common::Error& error) {
      out << error_line(error.code(), error.what()) << std::endl;
    } catch (const std::exception& error) {
      out << error_line(common::ExitCode::numerical_failure, error.what()) << std::endl;
    }
    if (done) break;
  }
  return sums;
}

std::string summary_line(const common::Split& split) {
  const auto count = [&](common::ParticleStatus status) {
    return std::count(split.particles.status.begin(), split.particles.status.end(), status);
  };
  return fmt::format(
      "frame {}: {} particles: {} intact, {} cracked, {} broken, {} not breakable, {} refused; {} growth steps",
      split.frame, split.particles.id.size(),
      count(common::ParticleStatus::intact) + count(common::ParticleStatus::screened),
      count(common::ParticleStatus::arrested), count(common::ParticleStatus::broken),
      count(common::ParticleStatus::not_breakable), count(common::ParticleStatus::refused), split.work.growth_steps);
}

}  // namespace xfem
