// A run that a guard has stopped. Oracles: the uninterrupted run, and the message of the failure itself, which what it
// leaves must give again.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "dem/failure.hpp"
#include "dem/run.hpp"
#include "tests/unit/dem/small_scene.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using dem_test::small_scene;

namespace {

/// The message of the failure, line by line; none if the run went on.
std::vector<std::string> failure_of(const common::Scene& scene, const fs::path& directory) {
  std::vector<std::string> lines;
  try {
    dem::run(scene, {directory, true, {}, {}}, {});
  } catch (const common::Error& error) {
    CHECK(error.code() == common::ExitCode::numerical_failure);
    std::istringstream text(error.what());
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> replay_of(const fs::path& directory) {
  return failure_of(common::read_scene(directory / "failure/case.yaml"), directory / "failure");
}

nlohmann::json record_of(const fs::path& directory) {
  return nlohmann::json::parse(std::ifstream(directory / "failure/failure.json"));
}

std::string hash_of(const fs::path& file) {
  return common::read_frame(file).payload_hash;
}

}  // namespace

TEST_CASE("what a stopped run leaves fails again alone, and the run goes on to the end it would have had") {
  const scratch::Folder root;
  const common::Scene scene = small_scene();
  REQUIRE(failure_of(scene, root.path() / "whole").empty());
  const std::string last = hash_of(root.path() / "whole/frames/000002.h5");

  struct Case {
    const char* guard;
    double common::GuardOptions::*limit;
    double value;
    bool sample_first;  // the preparation is that of the whole run
    const char* checkpoint;
  };
  const Case cases[] = {
      {"unbalanced_force", &common::GuardOptions::unbalanced_force, 1e-9, false, "frames/000000.h5"},
      {"energy_residual", &common::GuardOptions::energy_residual, 1e-13, false, "frames/000000.h5"},
      {"servo_error", &common::GuardOptions::servo_error, 1e-9, false, "frames/000001.h5"},
      {"overlap", &common::GuardOptions::overlap, 1e-7, false, nullptr},
      {"overlap", &common::GuardOptions::overlap, 1e-7, true, "prepared/sample.h5"},
      {"steps", &common::GuardOptions::steps, 10, true, "prepared/sample.h5"},
  };
  for (const Case& c : cases) {
    INFO(c.guard << (c.sample_first ? ", prepared" : ""));
    const fs::path directory = root.path() / "stopped";
    fs::remove_all(directory);
    if (c.sample_first) {
      fs::create_directories(directory);
      fs::copy(root.path() / "whole/prepared", directory / "prepared");
    }
    common::Scene strict = scene;
    strict.guards.*c.limit = c.value;
    const std::vector<std::string> said = failure_of(strict, directory);
    REQUIRE(said.size() == 3);
    CHECK_THAT(said[0], Contains(fmt::format("guards.{}", c.guard)));
    CHECK_THAT(said[1], Contains("failure/case.yaml"));
    const nlohmann::json record = record_of(directory);
    CHECK(record.at("guard") == c.guard);
    CHECK(record.at("checkpoint") == (c.checkpoint ? nlohmann::json(c.checkpoint) : nlohmann::json()));
    CHECK_THAT(said[0], Contains(record.at("reason").get<std::string>()));
    if (record.at("state").is_string()) {
      CHECK(common::read_frame(directory / "failure/state.h5").step == record.at("step"));
    }

    // Alone, moved elsewhere, twice.
    const fs::path moved = root.path() / "moved";
    fs::remove_all(moved);
    fs::create_directories(moved);
    fs::copy(directory / "failure", moved / "failure", fs::copy_options::recursive);
    for (int time = 0; time < 2; ++time) CHECK(replay_of(moved) == std::vector<std::string>{said[0]});
    CHECK_FALSE(fs::exists(moved / "failure/failure"));

    // The same again without a change; to the end with other guards.
    CHECK(failure_of(strict, directory) == said);
    CHECK(failure_of(scene, directory).empty());
    CHECK(hash_of(directory / "frames/000002.h5") == last);
    CHECK_FALSE(fs::exists(directory / "failure"));
    CHECK(common::read_scene(directory / "case.yaml").guards == scene.guards);
  }
}

TEST_CASE("a run from another run's sample leaves its sample too, wherever the failure is moved") {
  const scratch::Folder root;
  REQUIRE(failure_of(small_scene(), root.path() / "whole").empty());
  common::Scene scene = small_scene();
  scene.preparation.from = (root.path() / "whole/prepared/sample.h5").string();
  scene.guards.overlap = 1e-7;
  const fs::path directory = root.path() / "stopped";
  const std::vector<std::string> said = failure_of(scene, directory);
  REQUIRE(said.size() == 3);
  CHECK(record_of(directory).at("checkpoint") == "prepared/sample.h5");
  CHECK(replay_of(directory) == std::vector<std::string>{said[0]});
  fs::rename(directory / "failure", root.path() / "failure");
  fs::remove_all(directory);
  fs::remove_all(root.path() / "whole");
  for (int time = 0; time < 2; ++time) CHECK(replay_of(root.path()) == std::vector<std::string>{said[0]});
}

TEST_CASE("a refused particle stops the run at its split, before the next step") {
  const scratch::Folder root;
  common::Scene scene = small_scene();
  scene.effects.breakage = true;
  scene.breakage.interval = 0.001;
  const fs::path directory = root.path() / "run";
  REQUIRE(failure_of(scene, directory).empty());  // pauses for its first split
  const common::Frame frame = common::read_frame(directory / "frames/000000.h5");
  common::Split split;
  split.frame_hash = frame.payload_hash;
  for (const std::int64_t id : frame.particles.id) {
    split.particles.id.push_back(id);
    split.particles.status.push_back(common::ParticleStatus::intact);
    split.particles.mean_stress.push_back({0, 0, 0});
    split.particles.min_safety_factor.push_back(2);
    split.particles.failure_mode.push_back(common::FailureMode::none);
  }
  split.particles.status[3] = common::ParticleStatus::refused;
  split.refusals = {{frame.particles.id[3]}, {"made up"}};
  fs::create_directories(directory / "splits");
  common::write_split(directory / "splits/000000.h5", split, {});

  const std::vector<std::string> said = failure_of(scene, directory);
  REQUIRE(said.size() == 3);
  CHECK_THAT(said[0], Contains("frame 0") && Contains("particle 3: made up"));
  CHECK_FALSE(fs::exists(directory / "frames/000001.h5"));
  CHECK(record_of(directory).at("split") == "splits/000000.h5");
  CHECK(replay_of(directory) == std::vector<std::string>{said[0]});
  scene.guards.refusals = common::Refusals::go_on;
  CHECK(failure_of(scene, directory).empty());
  CHECK(fs::exists(directory / "frames/000001.h5"));
}

TEST_CASE("a failure that cannot be written down is told all the same") {
  const scratch::Folder root;
  const common::Scene scene = small_scene();
  REQUIRE(failure_of(scene, root.path()).empty());
  fs::remove(root.path() / "frames/000002.h5");
  fs::create_symlink("nowhere/at/all", root.path() / "failure");  // where the folder should be
  common::Scene strict = scene;
  strict.guards.unbalanced_force = 1e-9;
  const std::vector<std::string> said = failure_of(strict, root.path());
  REQUIRE(said.size() == 3);
  CHECK_THAT(said[0], Contains("frame 2") && Contains("the unbalanced force is"));
  CHECK_THAT(said[1], Contains("could not be kept") && Contains("failure"));
}

TEST_CASE("a time step too large ends the executable with code 3, and so does what it leaves") {
  const scratch::Folder root;
  fs::create_directories(root.path());
  common::Scene scene = small_scene();
  scene.contact.law = common::ContactLaw::potential;
  scene.contact.normal_stiffness = 1e9;
  scene.time_step.safety = 0.8;
  std::ofstream(root.path() / "scene.yaml") << common::to_yaml(scene);
  const auto run = [&](const std::string& arguments) {
    const std::string out = (root.path() / "said").string();
    const int status =
        std::system(fmt::format("{}/dem run {} 2>{} >/dev/null", ROCKBREAK_BINARY_DIR, arguments, out).c_str());
    std::ifstream stream(out);
    std::string error;
    for (std::string line; std::getline(stream, line);) {
      if (line.starts_with("dem: error:")) error = line;
    }
    return std::pair{WIFEXITED(status) ? WEXITSTATUS(status) : -1, error};
  };
  const std::string out = (root.path() / "run").string();
  const auto first = run(fmt::format("{}/scene.yaml --out {}", root.path().string(), out));
  CHECK(first.first == 3);
  CHECK_THAT(first.second, Contains("time step may be too large") && Contains("particle"));
  CHECK(run(fmt::format("{0}/failure/case.yaml --out {0}/failure --resume", out)) == first);
}
