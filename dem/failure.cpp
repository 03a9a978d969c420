#include "dem/failure.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <system_error>

#include "common/error.hpp"
#include "common/io/frame.hpp"
#include "common/io/provenance.hpp"

namespace fs = std::filesystem;

namespace dem {
namespace {

constexpr const char* kRecord = "failure.json";
constexpr const char* kState = "state.h5";
constexpr const char* kCase = "case.yaml";

void copy_whole(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  if (error) {
    throw common::io_failure(fmt::format("{}: cannot create: {}", to.parent_path().string(), error.message()));
  }
  common::write_atomically(to, common::read_whole_file(from), {});
}

void write_text(const fs::path& path, const std::string& text) {
  common::write_atomically(path, std::as_bytes(std::span(text)), {});
}

// Where the copy of a checkpoint stands: as in the run, but a sample of another run becomes the prepared sample.
fs::path place_of(const fs::path& checkpoint, const common::Scene& scene) {
  if (!scene.preparation.from.empty() && checkpoint == fs::path(scene.preparation.from)) return "prepared/sample.h5";
  return checkpoint.parent_path().filename() / checkpoint.filename();
}

bool is_sheared(const Failure& failure) {
  return failure.stage == name_of(Phase::shear);
}

// The command that analyses a refused particle alone, if xfem has left its file in this run (xfem/refusal.hpp).
std::string refused_alone(const fs::path& directory, const Failure& failure) {
  const std::string particle = (directory / "failure").string() +
                               fmt::format("/frame_{:06}_particle_{}", failure.frame, failure.finding.particles[0]);
  if (!fs::exists(particle + ".h5")) return {};
  const bool cracked = fs::exists(particle + "_previous.h5");
  return fmt::format("the particle alone: xfem solve {0}.h5 --config {1}{2} --out SPLIT.h5", particle,
                     (directory / "case.yaml").string(),
                     cracked ? fmt::format(" --previous {}_previous.h5", particle) : "");
}

}  // namespace

bool is_failure(const fs::path& directory) {
  std::error_code ignored;
  return fs::exists(directory / kRecord, ignored);
}

void remove_failure(const fs::path& directory) {
  std::error_code ignored;
  const fs::path folder = directory / "failure";
  if (!fs::exists(folder, ignored)) return;
  for (const char* name : {kRecord, kState, kCase, "frames", "splits", "prepared", ".lock", "run.jsonl"}) {
    fs::remove_all(folder / name, ignored);
  }
  fs::remove(folder, ignored);  // stays if it holds something else
}

void write_failure(const fs::path& directory, const common::Scene& scene, const Failure& failure, common::Frame state) {
  remove_failure(directory);
  const fs::path folder = directory / "failure";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw common::io_failure(fmt::format("{}: cannot create: {}", folder.string(), error.message()));

  nlohmann::ordered_json record{{"schema", "failure/1"},
                                {"guard", failure.finding.guard},
                                {"reason", failure.finding.text},
                                {"stage", failure.stage},
                                {"frame", failure.frame},
                                {"step", failure.step},
                                {"time", failure.time},
                                {"axial_strain", failure.axial_strain},
                                {"particles", failure.finding.particles},
                                {"numbers", nlohmann::ordered_json::object()},
                                {"checkpoint", nullptr},
                                {"split", nullptr},
                                {"state", nullptr},
                                {"replay", "dem run case.yaml --out . --resume"},
                                {"program", common::provenance()}};
  for (const auto& [name, value] : failure.finding.numbers) record["numbers"][name] = value;

  common::Scene replay = scene;
  if (!failure.checkpoint.empty()) {
    const fs::path place = place_of(failure.checkpoint, scene);
    copy_whole(failure.checkpoint, folder / place);
    record["checkpoint"] = place.string();
    if (failure.checkpoint == fs::path(scene.preparation.from)) replay.preparation.from = place.string();
  }
  if (!failure.split.empty()) {
    const fs::path place = fs::path("splits") / failure.checkpoint.filename();
    copy_whole(failure.split, folder / place);
    record["split"] = place.string();
  }
  write_text(folder / kCase, common::to_yaml(replay));
  try {
    common::write_frame(folder / kState, state, {});
    record["state"] = kState;
  } catch (const common::Error& refused) {
    if (refused.code() != common::ExitCode::numerical_failure) throw;
    record["numbers"]["state"] = refused.what();
  }
  write_text(folder / kRecord, record.dump(2) + "\n");
}

bool is_refusal(const Failure& failure) {
  return failure.finding.guard == "refusals";
}

std::string place_and_reason(const Failure& failure) {
  return (is_sheared(failure) ? fmt::format("frame {} (step {}, axial strain {:.6f}): ", failure.frame, failure.step,
                                            failure.axial_strain)
                              : fmt::format("{} (step {}): ", failure.stage, failure.step)) +
         failure.finding.text;
}

std::string keep_and_advise(const fs::path& directory, const common::Scene& scene, const Failure& failure,
                            common::Frame state) {
  std::string text;
  try {
    write_failure(directory, scene, failure, std::move(state));
    const std::string particle = is_refusal(failure) ? refused_alone(directory, failure) : std::string();
    text = '\n' + (particle.empty() ? fmt::format("the failure alone: dem run {0}/failure/case.yaml --out {0}/failure "
                                                  "--resume",
                                                  directory.string())
                                    : particle);
  } catch (const common::Error& not_kept) {
    text = fmt::format("\nthe failure could not be kept: {}", not_kept.what());
  }
  text += fmt::format("\nthe files of {} are valid: --resume goes on with other guards (--set guards.KEY=VALUE)",
                      directory.string());
  if (is_sheared(failure) && !is_refusal(failure)) {
    const std::string& from = scene.preparation.from;
    text += fmt::format(
        "; a smaller time_step.safety or another contact law takes a new directory, from the same sample with --set "
        "preparation.from={}",
        from.empty() ? (directory / "prepared/sample.h5").string() : from);
  }
  return text;
}

}  // namespace dem
