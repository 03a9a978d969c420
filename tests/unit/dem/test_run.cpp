// Resumption of `dem run` in a directory. Oracle: the run that was not interrupted, and INTERFACES, Resume.
#include <fmt/format.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "common/error.hpp"
#include "common/io/frame.hpp"
#include "dem/run.hpp"
#include "tests/unit/dem/small_scene.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

namespace {

// Seed 2, in which some contacts slide at rest.
common::Scene sliding_scene() {
  common::Scene scene = dem_test::small_scene();
  scene.effects.energy_ledger = false;
  scene.seed = 2;
  return scene;
}

struct Outcome {
  dem::RunEnd end;
  int events = 0;  ///< progress reports of the preparation
  std::string warnings;
};

Outcome go_on(const common::Scene& scene, const fs::path& directory, std::optional<std::int64_t> until_frame = {}) {
  Outcome outcome{};
  dem::RunPorts ports;
  ports.progress = [&](const std::string& event) {
    if (event.find("void_ratio") != std::string::npos) ++outcome.events;
    if (event.find("warning") != std::string::npos) outcome.warnings += event;
  };
  outcome.end = dem::run(scene, {directory, true, until_frame, {}}, ports);
  return outcome;
}

std::string hash_of(const fs::path& file) {
  return common::read_frame(file).payload_hash;
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("a run goes on from whatever is left of it, and a case.yaml tells of the scene that runs") {
  const scratch::Folder root;
  const fs::path whole = root / "whole";
  const common::Scene scene = sliding_scene();
  const Outcome first = go_on(scene, whole);
  CHECK(first.end == dem::RunEnd::finished);
  CHECK(first.events > 0);
  CHECK_THAT(first.warnings, Contains("void ratio") && Contains("0.9"));
  const std::string last = hash_of(whole / "frames/000002.h5");
  const std::string resolved = text_of(whole / "case.yaml");

  SECTION("the first row of the history counts the contacts at the Coulomb limit, as every other") {
    const common::Frame frame = common::read_frame(whole / "frames/000000.h5");
    int sliding = 0;
    for (std::size_t k = 0; k < frame.contacts.size(); ++k) {
      sliding += std::abs(frame.contacts.shear_force[k]) > 0.999999 * frame.friction * frame.contacts.normal_force[k];
    }
    REQUIRE(sliding > 0);
    for (const common::Column& c : frame.history) {
      if (c.name != "sliding_fraction") continue;
      CHECK(c.values.front() * static_cast<double>(frame.contacts.size()) == Approx(sliding));
    }
  }
  SECTION("a finished run ends at once") {
    const auto written = fs::last_write_time(whole / "frames/000002.h5");
    CHECK(go_on(scene, whole).end == dem::RunEnd::finished);
    CHECK(fs::last_write_time(whole / "frames/000002.h5") == written);
  }
  SECTION("killed between the sample and frame 0: the sample is reused, and its shortcomings are told again") {
    fs::remove_all(whole / "frames");
    fs::remove(whole / "case.yaml");
    const Outcome again = go_on(scene, whole);
    CHECK(again.events == 0);
    CHECK(again.warnings == first.warnings);
    CHECK(hash_of(whole / "frames/000002.h5") == last);
    CHECK(text_of(whole / "case.yaml") == resolved);
  }
  SECTION("a damaged frame is passed over, and said to be") {
    std::ofstream(whole / "frames/000002.h5", std::ios::binary) << "torn";
    const Outcome again = go_on(scene, whole);
    CHECK_THAT(again.warnings, Contains("000002.h5") && Contains("passed over"));
    CHECK(hash_of(whole / "frames/000002.h5") == last);
  }
  SECTION("a frame that is reached already is not passed") {
    fs::remove(whole / "frames/000002.h5");
    CHECK(go_on(scene, whole, 1).end == dem::RunEnd::paused);
    CHECK_FALSE(fs::exists(whole / "frames/000002.h5"));
  }
  SECTION("a case.yaml with nothing that was made with it gives way") {
    fs::remove_all(whole / "frames");
    fs::remove_all(whole / "prepared");
    common::Scene other = scene;
    other.seed = 2;
    other.shear.axial_strain = 0.001;
    go_on(other, whole);
    CHECK_THAT(text_of(whole / "case.yaml"), Contains("seed: 2"));
  }
  SECTION("another configuration is refused, whether frames or only the sample stand there") {
    common::Scene other = scene;
    other.contact.friction = 0.4;
    CHECK_THROWS_WITH(go_on(other, whole), Contains("another configuration"));
    fs::remove_all(whole / "frames");
    CHECK_THROWS_WITH(go_on(other, whole), Contains("sample.h5") && Contains("another configuration"));
  }
  SECTION("a test starts from a sample, not from the middle of a preparation") {
    common::Scene follower = scene;
    follower.preparation.from = (whole / "prepared/sample.h5").string();
    go_on(follower, root / "follower");
    CHECK(hash_of(root / "follower/frames/000002.h5") == last);
    common::Scene denser = follower;
    denser.material.density = 2600;
    CHECK_THROWS_WITH(go_on(denser, root / "denser"), Contains("density of 2500") && Contains("2600"));
    const fs::path early = root / "early/prepared/000000.h5";
    dem::RunPorts ports;
    ports.interrupted = [&] { return fs::exists(early); };
    CHECK(dem::run(scene, {root / "early", false, {}, {}}, ports) == dem::RunEnd::interrupted);
    follower.preparation.from = early.string();
    CHECK_THROWS_WITH(go_on(follower, root / "refused"), Contains("middle of a preparation"));
  }
}
