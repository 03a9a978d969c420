#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "common/error.hpp"
#include "sample_frame.hpp"
#include "xfem/serve.hpp"

namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void silent(const std::string&) {}

/// Frame 7, and frame 8 without the particles that broke, under the same forces.
void write_two_frames(const scratch::Folder& directory) {
  common::Frame first = sample::frame();
  common::write_frame(directory / "7.h5", first, {});
  const common::Split split = xfem::FrameSolver(sample::scene(), 1).solve(first, nullptr);
  common::Frame second = sample::walls();
  second.frame = 8;
  for (std::size_t i = sample::kWalls; i < first.particles.size(); ++i) {
    if (split.particles.status[i] == common::ParticleStatus::broken) continue;
    second.next_id = first.particles.id[i];
    const auto outline = first.particles.outline(i);
    sample::add_pressed(second, {outline.begin(), outline.end()}, first.particles.position[i], 0.1, {2e6, 0.2});
  }
  sample::sort_contacts(second.contacts);
  common::write_frame(directory / "8.h5", second, {});
}

}  // namespace

TEST_CASE("the resident service answers with the bytes of one-shot processes") {
  const scratch::Folder directory;
  write_two_frames(directory);
  const auto path = [&](const char* name) { return (directory / name).string(); };

  xfem::SplitService resident(sample::scene(), 2, silent);
  std::istringstream in("solve " + path("7.h5") + " - " + path("7r.h5") + "\nsolve " + path("8.h5") + " " +
                        path("7r.h5") + " " + path("8r.h5") + "\ndone\nsolve never - read\n");
  std::ostringstream out;
  xfem::serve(resident, in, out);

  std::ostringstream expected;
  {
    xfem::SplitService one_shot(sample::scene(), 1, silent);
    const auto& answer = one_shot.solve(path("7.h5"), std::nullopt, path("7s.h5"));
    expected << "split " << path("7r.h5") << " " << answer.file.bytes << " " << answer.file.payload_hash << "\n";
  }
  {
    xfem::SplitService one_shot(sample::scene(), 1, silent);
    const auto& answer = one_shot.solve(path("8.h5"), path("7s.h5"), path("8s.h5"));
    expected << "split " << path("8r.h5") << " " << answer.file.bytes << " " << answer.file.payload_hash << "\n";
  }
  expected << "done\n";
  CHECK(out.str() == expected.str());
  CHECK(bytes_of(directory / "7r.h5") == bytes_of(directory / "7s.h5"));
  CHECK(bytes_of(directory / "8r.h5") == bytes_of(directory / "8s.h5"));
  CHECK(std::filesystem::file_size(directory / "8r.h5") > 0);
}

TEST_CASE("the service reads the previous split again if its file has changed") {
  const scratch::Folder directory;
  write_two_frames(directory);
  xfem::SplitService service(sample::scene(), 1, silent);
  service.solve(directory / "7.h5", std::nullopt, directory / "7s.h5");
  std::ofstream(directory / "7s.h5") << "no longer a split";
  CHECK_THROWS_AS(service.solve(directory / "8.h5", directory / "7s.h5", directory / "8s.h5"), common::Error);
  CHECK_FALSE(std::filesystem::exists(directory / "8s.h5"));
}

TEST_CASE("failures are answered in one line and the service goes on") {
  const scratch::Folder directory;
  common::Frame frame = sample::frame();
  common::write_frame(directory / "7.h5", frame, {});
  xfem::SplitService service(sample::scene(), 1, silent);
  std::istringstream in("solve\nfrobnicate a b c\nsolve /nowhere/1.h5 - /nowhere/2.h5\nsolve " +
                        (directory / "7.h5").string() + " - " + (directory / "7s.h5").string() + "\n");
  std::ostringstream out;
  xfem::serve(service, in, out);
  std::istringstream answers(out.str());
  std::string line;
  for (int k = 0; k < 2; ++k) {
    REQUIRE(std::getline(answers, line));
    CHECK_THAT(line, Catch::StartsWith("error 2 ") && Catch::Contains("expected `solve FRAME PREVIOUS|- OUT`"));
  }
  REQUIRE(std::getline(answers, line));
  CHECK_THAT(line, Catch::StartsWith("error ") && Catch::Contains("/nowhere/1.h5"));
  REQUIRE(std::getline(answers, line));
  CHECK_THAT(line, Catch::StartsWith("split "));
  CHECK_FALSE(std::getline(answers, line));
}
