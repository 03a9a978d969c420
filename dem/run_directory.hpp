// Where the files of a run stand, and which of them is the newest that can be trusted.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "common/config/scene.hpp"
#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "dem/directory_lock.hpp"

namespace dem {

class RunDirectory {
 public:
  /// Creates DIR with its folders, or checks that an existing one may be used: empty (but for .lock, run.jsonl and
  /// empty folders) unless `resume`. It is locked for as long as this object lives. Throws bad_input, io_failure.
  /// `warn` is told of every damaged file that a resumed run passes over.
  RunDirectory(std::filesystem::path root, bool resume, std::function<void(const std::string&)> warn);

  std::filesystem::path frame(std::int64_t index) const { return numbered("frames", index); }
  std::filesystem::path split(std::int64_t index) const { return numbered("splits", index); }
  std::filesystem::path preparation(std::int64_t index) const { return numbered("prepared", index); }
  /// The prepared sample, as `preparation.from` of other scenes takes it.
  std::filesystem::path sample() const { return root_ / "prepared" / "sample.h5"; }

  /// Writes case.yaml; one that is there is kept, but for its guards, or replaced.
  enum class Existing { kept, replaced };
  void write_case(const common::Scene& scene, Existing existing) const;

  /// Newest frame that reads without an error; newer broken ones are passed over. Throws bad_input if it was made with
  /// another configuration than `config_hash`.
  std::optional<common::Frame> newest_frame(const std::string& config_hash) const;
  /// The same for preparation checkpoints; `index` is set to its number.
  std::optional<common::Frame> newest_preparation(const std::string& config_hash, std::int64_t& index) const;
  /// The prepared sample, if it is there and reads without an error. Throws as above.
  std::optional<common::Frame> prepared_sample(const std::string& config_hash) const;
  /// Removes all preparation checkpoints but the newest two before `index`.
  void drop_preparations_before(std::int64_t index) const;

 private:
  std::filesystem::path numbered(const char* kind, std::int64_t index) const;
  void check_configuration(const common::Frame& frame, const std::filesystem::path& path,
                           const std::string& config_hash) const;
  std::optional<common::Frame> newest(const char* kind, const std::string& config_hash, std::int64_t& index) const;

  std::optional<common::Frame> read_if_whole(const std::filesystem::path& path) const;

  std::filesystem::path root_;
  std::function<void(const std::string&)> warn_;
  std::optional<DirectoryLock> lock_;
};

}  // namespace dem
