// The executable itself: what it prints, where, and its exit codes.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "sample_frame.hpp"

namespace {

const std::string kExecutable = std::string(ROCKBREAK_BINARY_DIR) + "/xfem";

struct Outcome {
  int code;
  std::string out, err;
};

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Outcome run(const scratch::Folder& directory, const std::string& arguments, const std::string& input = "") {
  std::ofstream(directory / "stdin") << input;
  const std::string out = (directory / "stdout").string(), err = (directory / "stderr").string();
  const int status = std::system(
      (kExecutable + " " + arguments + " <" + (directory / "stdin").string() + " >" + out + " 2>" + err).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
}

/// A directory with frame.h5 and case.yaml.
struct Workspace {
  scratch::Folder directory;
  Workspace() {
    common::Frame frame = sample::frame();
    common::write_frame(directory / "frame.h5", frame, {});
    std::ofstream(directory / "case.yaml") << common::to_yaml(sample::scene());
  }
  std::string at(const std::string& name) const { return (directory / name).string(); }
  std::string solve(const std::string& more) const {
    return "solve " + at("frame.h5") + " --config " + at("case.yaml") + " " + more;
  }
};

}  // namespace

TEST_CASE("solve is silent on stdout, and serve writes the same bytes") {
  const Workspace work;
  const Outcome solved =
      run(work.directory, work.solve("--threads 2 --out " + work.at("a.h5") + " --profile " + work.at("p.json")));
  INFO(solved.err);
  REQUIRE(solved.code == 0);
  CHECK(solved.out.empty());
  CHECK_THAT(solved.err, Catch::Contains("frame 7: 19 particles"));
  const auto profile = nlohmann::json::parse(text_of(work.directory / "p.json"));
  CHECK(profile["seconds"]["analysis"] > 0);
  CHECK(profile["counts"]["particles"] == 19);

  const std::string order = "solve " + work.at("frame.h5") + " - " + work.at("b.h5") + "\n";
  const Outcome served =
      run(work.directory, "serve --profile - --config " + work.at("case.yaml"), order + order + "done\n");
  CHECK(served.code == 0);
  const std::size_t event = served.err.find(R"({"event":"profile")");
  REQUIRE(event != std::string::npos);
  const auto sums = nlohmann::json::parse(served.err.substr(event));
  CHECK(sums["seconds"]["analysis"] > 0);
  CHECK(sums["counts"]["particles"] == 2 * 19);
  const std::string bytes = text_of(work.directory / "a.h5");
  CHECK_THAT(served.out, Catch::StartsWith("split " + work.at("b.h5") + " " + std::to_string(bytes.size()) + " "));
  CHECK(text_of(work.directory / "b.h5") == bytes);
}

TEST_CASE("bad input ends with exit code 2 and a message that says what and where") {
  const Workspace work;
  const std::string out = "--out " + work.at("s.h5");
  const auto refuses = [&](const std::string& arguments, const std::string& expected) {
    const Outcome outcome = run(work.directory, arguments);
    INFO(arguments);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Catch::Contains(expected));
    CHECK_FALSE(std::filesystem::exists(work.directory / "s.h5"));
  };
  refuses("", "subcommand is required");
  refuses("solve", "required");
  refuses(work.solve("--out"), "--out");
  refuses(work.solve(out + " --set breakage.node=50"), "did you mean \"nodes\"?");
  refuses(work.solve(out + " --set material.young_modulus=-1"), "young_modulus");
  refuses(work.solve(out + " --set effects=[friction]"), "do not name breakage");
  refuses("check " + work.at("nothing.yaml"), "xfem: error: " + work.at("nothing.yaml"));

  const std::string whole = text_of(work.directory / "frame.h5");
  std::ofstream(work.directory / "frame.h5", std::ios::binary) << whole.substr(0, whole.size() / 2);
  refuses(work.solve(out), "frame.h5");
}

TEST_CASE("a previous split of another configuration or a later frame is refused") {
  const Workspace work;
  const std::string first = work.at("first.h5");
  REQUIRE(run(work.directory, work.solve("--out " + first)).code == 0);
  const Outcome same = run(work.directory, work.solve("--previous " + first + " --out " + work.at("s.h5")));
  CHECK(same.code == 2);
  CHECK_THAT(same.err, Catch::Contains("belongs to frame 7, expected one before frame 7"));
  const Outcome other =
      run(work.directory, work.solve("--previous " + first + " --set breakage.nodes=90 --out " + work.at("s.h5")));
  CHECK(other.code == 2);
  CHECK_THAT(other.err, Catch::Contains("made with configuration"));
  // A frame made with other keys is welcome: the sample's own hash is not this scene's.
  CHECK(run(work.directory, work.solve("--set material.m_i=15.0 --out " + work.at("s.h5"))).code == 0);
}

TEST_CASE("a directory that cannot be written is an input/output failure") {
  const Workspace work;
  const Outcome outcome = run(work.directory, work.solve("--out " + work.at("frame.h5") + "/inside.h5"));
  CHECK(outcome.code == 4);
  CHECK_THAT(outcome.err, Catch::Contains("inside.h5"));
}

TEST_CASE("check and explain read scenes and laboratory tests") {
  const Workspace work;
  const std::string labs = std::string(ROCKBREAK_SOURCE_DIR) + "/configs/lab/";
  for (const std::string& file : {work.at("case.yaml"), labs + "brazilian.yaml", labs + "uniaxial.yaml"}) {
    const Outcome checked = run(work.directory, "check " + file);
    CHECK(checked.code == 0);
    CHECK(checked.out == file + ": ok\n");
    const Outcome explained = run(work.directory, "explain " + file);
    CHECK(explained.code == 0);
    CHECK_THAT(explained.out, Catch::Contains("sigma_ci") && Catch::Contains("three-node triangles"));
  }
  CHECK_THAT(run(work.directory, "explain " + work.at("case.yaml") + " --set breakage.nodes=111").out,
             Catch::Contains("about 111 nodes"));
}

TEST_CASE("signals end the resident service with their exit codes") {
  const Workspace work;
  for (const auto& [signal, code] : {std::pair{SIGTERM, 143}, {SIGINT, 130}}) {
    int to_child[2], from_child[2];
    REQUIRE(pipe(to_child) == 0);
    REQUIRE(pipe(from_child) == 0);
    const pid_t child = fork();
    if (child == 0) {
      dup2(to_child[0], 0);
      dup2(from_child[1], 1);
      close(to_child[1]);
      execl(kExecutable.c_str(), "xfem", "serve", "--config", work.at("case.yaml").c_str(), nullptr);
      _exit(99);
    }
    // Its answer shows that it is up and waiting.
    char byte = 0;
    REQUIRE(write(to_child[1], "hello\n", 6) == 6);
    while (byte != '\n') REQUIRE(read(from_child[0], &byte, 1) == 1);
    kill(child, signal);
    int status = 0;
    waitpid(child, &status, 0);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == code);
    for (int end : {to_child[0], to_child[1], from_child[0], from_child[1]}) close(end);
  }
}

TEST_CASE("a refused particle is told, stands in a file of its own, and is refused alone for the same reason") {
  const Workspace work;
  common::Frame frame = sample::frame();
  const std::int64_t id = sample::kFirstCrushed;
  REQUIRE(frame.contacts.b[2] == id);
  frame.contacts.force[2].x() = 1.7e308;  // a number, but its stress is none
  std::filesystem::create_directories(work.directory / "run/splits");
  common::write_frame(work.directory / "frame.h5", frame, {});
  common::Split previous;
  previous.frame = frame.frame - 1;
  previous.config_hash = common::config_hash(sample::scene(), common::UsedBy::xfem);
  for (const std::int64_t cracked : {id, id + 1}) {
    previous.particles.id.push_back(cracked);
    previous.particles.status.push_back(common::ParticleStatus::arrested);
    previous.particles.mean_stress.push_back({0, 0, 0});
    previous.particles.min_safety_factor.push_back(1);
    previous.particles.failure_mode.push_back(common::FailureMode::tension);
    previous.cracks.particle.push_back(cracked);
    previous.cracks.points.insert(previous.cracks.points.end(), {{-0.05, 0}, {0, 0.01}, {0.05, 0}});
    previous.cracks.point_offset.push_back(static_cast<std::int64_t>(previous.cracks.points.size()));
  }
  common::write_split(work.directory / "previous.h5", previous, {});
  const Outcome whole = run(
      work.directory, work.solve("--previous " + work.at("previous.h5") + " --out " + work.at("run/splits/000007.h5")));
  INFO(whole.err);
  CHECK(whole.code == 0);
  const std::string name = work.at("run/failure/frame_000007_particle_" + std::to_string(id));
  const std::string command = "solve " + name + ".h5 --config CASE.yaml --previous " + name + "_previous.h5 --out ";
  CHECK_THAT(whole.err,
             Catch::Contains("particle " + std::to_string(id) + ": analysis refused: ") && Catch::Contains(command));
  const common::Split split = common::read_split(work.directory / "run/splits/000007.h5");
  REQUIRE(split.refusals.particle == std::vector<std::int64_t>{id});

  const Outcome alone = run(work.directory, "solve " + name + ".h5 --config " + work.at("case.yaml") + " --previous " +
                                                name + "_previous.h5 --out " + work.at("alone.h5"));
  INFO(alone.err);
  CHECK(alone.code == 0);
  const common::Split own = common::read_split(work.directory / "alone.h5");
  CHECK(own.refusals.particle == split.refusals.particle);
  CHECK(own.refusals.reason == split.refusals.reason);
  CHECK(own.cracks.particle == std::vector<std::int64_t>{id});  // what it had, and nobody else's

  std::filesystem::remove_all(work.directory / "run/failure");
  std::ofstream(work.directory / "run/failure") << "in the way";
  const Outcome full = run(work.directory, work.solve("--out " + work.at("run/splits/000007.h5")));
  CHECK(full.code == 0);
  CHECK_THAT(full.err, Catch::Contains("could not be kept"));
}
