#include "dem/run_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <system_error>
#include <vector>

#include "common/error.hpp"

namespace fs = std::filesystem;

namespace dem {
namespace {

// Number of a file named 000012.h5, or -1.
std::int64_t number_of(const fs::path& file) {
  if (file.extension() != ".h5") return -1;
  const std::string stem = file.stem().string();
  std::int64_t value = -1;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), value);
  return error == std::errc() && end == stem.data() + stem.size() ? value : -1;
}

std::vector<std::int64_t> numbers_in(const fs::path& folder) {
  std::vector<std::int64_t> numbers;
  if (!fs::is_directory(folder)) return numbers;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (const std::int64_t n = number_of(entry.path()); n >= 0) numbers.push_back(n);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace

RunDirectory::RunDirectory(fs::path root, bool resume, std::function<void(const std::string&)> warn)
    : root_(std::move(root)), warn_(std::move(warn)) {
  std::error_code error;
  if (fs::exists(root_, error) && !fs::is_directory(root_, error)) {
    throw common::bad_input(fmt::format("{}: is a file, expected a directory for the run", root_.string()));
  }
  if (!resume && fs::is_directory(root_, error)) {
    for (const auto& entry : fs::directory_iterator(root_, error)) {
      const std::string name = entry.path().filename().string();
      if (name == ".lock" || name == "run.jsonl") continue;
      if (entry.is_directory(error) && fs::is_empty(entry.path(), error)) continue;  // of a start that was refused
      throw common::bad_input(
          fmt::format("{}: not empty (holds {}); give --resume to go on with that run, or name a new directory",
                      root_.string(), name));
    }
  }
  for (const char* folder : {"frames", "prepared"}) {
    fs::create_directories(root_ / folder, error);
    if (error)
      throw common::io_failure(fmt::format("{}: cannot create: {}", (root_ / folder).string(), error.message()));
  }
  lock_.emplace(root_);
}

fs::path RunDirectory::numbered(const char* kind, std::int64_t index) const {
  return root_ / kind / fmt::format("{:06}.h5", index);
}

void RunDirectory::write_case(const common::Scene& scene, Existing existing) const {
  const fs::path path = root_ / "case.yaml";
  std::string text = common::to_yaml(scene);
  if (existing == Existing::kept && fs::exists(path)) {
    // What stands there stays in force, but for the guards: a run goes on with those that it is resumed with.
    try {
      common::Scene kept = common::read_scene(path);
      if (kept.guards == scene.guards) return;
      kept.guards = scene.guards;
      text = common::to_yaml(kept);
    } catch (const common::Error&) {
      return;
    }
  }
  common::write_atomically(path, std::as_bytes(std::span(text)), common::kDurable);
}

void RunDirectory::check_configuration(const common::Frame& frame, const fs::path& path,
                                       const std::string& config_hash) const {
  if (frame.config_hash == config_hash) return;
  throw common::bad_input(
      fmt::format("{}: was made with another configuration; resume with the scene in {}, or name a new directory",
                  path.string(), (root_ / "case.yaml").string()));
}

// A frame, or nothing if the file is damaged: an older one serves as well.
std::optional<common::Frame> RunDirectory::read_if_whole(const fs::path& path) const {
  try {
    return common::read_frame(path);
  } catch (const common::Error& error) {
    warn_(fmt::format("{}; the file is passed over, what it held is computed anew", error.what()));
    return std::nullopt;
  }
}

std::optional<common::Frame> RunDirectory::prepared_sample(const std::string& config_hash) const {
  if (!fs::exists(sample())) return std::nullopt;
  std::optional<common::Frame> frame = read_if_whole(sample());
  if (frame) check_configuration(*frame, sample(), config_hash);
  return frame;
}

std::optional<common::Frame> RunDirectory::newest(const char* kind, const std::string& config_hash,
                                                  std::int64_t& index) const {
  const std::vector<std::int64_t> numbers = numbers_in(root_ / kind);
  for (auto n = numbers.rbegin(); n != numbers.rend(); ++n) {
    std::optional<common::Frame> frame = read_if_whole(numbered(kind, *n));
    if (!frame) continue;
    check_configuration(*frame, numbered(kind, *n), config_hash);
    index = *n;
    return frame;
  }
  return std::nullopt;
}

std::optional<common::Frame> RunDirectory::newest_frame(const std::string& config_hash) const {
  std::int64_t index = 0;
  return newest("frames", config_hash, index);
}

std::optional<common::Frame> RunDirectory::newest_preparation(const std::string& config_hash,
                                                              std::int64_t& index) const {
  return newest("prepared", config_hash, index);
}

void RunDirectory::drop_preparations_before(std::int64_t index) const {
  for (const std::int64_t n : numbers_in(root_ / "prepared")) {
    std::error_code ignored;
    if (n < index - 1) fs::remove(preparation(n), ignored);
  }
}

}  // namespace dem
