// A particle of a frame on its own. Oracle: its analysis in the whole frame.
#include <catch2/catch.hpp>

#include "sample_frame.hpp"
#include "xfem/refusal.hpp"
#include "xfem/solve_frame.hpp"

TEST_CASE("alone in its frame a particle comes to the same result, bit for bit") {
  const common::Frame frame = sample::frame();
  xfem::FrameSolver solver(sample::scene(), 1);
  const common::Split whole = solver.solve(frame, nullptr);
  int broken = 0, compared = 0;
  for (std::size_t i = 0; i < frame.particles.size(); ++i) {
    if (frame.particles.boundary[i]) continue;
    const std::int64_t id = frame.particles.id[i];
    const common::Frame own = xfem::frame_of_particle(frame, id);
    const common::Split alone = solver.solve(own, nullptr);
    std::size_t k = 0;
    while (own.particles.id[k] != id) ++k;
    CHECK(own.particles.size() < frame.particles.size());
    CHECK(alone.particles.status[k] == whole.particles.status[i]);
    CHECK(alone.particles.mean_stress[k] == whole.particles.mean_stress[i]);
    for (std::size_t other = 0; other < own.particles.size(); ++other) {
      if (other != k) CHECK(alone.particles.status[other] == common::ParticleStatus::not_breakable);
    }
    broken += alone.particles.status[k] == common::ParticleStatus::broken;
    ++compared;
  }
  CHECK(broken > 0);
  CHECK(compared > 5);
  CHECK(xfem::refusal_folder("run/splits/000003.h5") == std::filesystem::path("run/failure"));
  CHECK(xfem::refusal_folder("splits/000003.h5") == std::filesystem::path("failure"));
  CHECK(xfem::refusal_folder("again.h5") == std::filesystem::path("failure"));
}

TEST_CASE("a run that goes on past refusals keeps two hundred files, ten of a frame") {
  const scratch::Folder directory;
  common::Frame frame = sample::frame();
  common::Split split;
  for (std::size_t i = 0; i < 12; ++i) {
    split.refusals.particle.push_back(frame.particles.id[i]);
    split.refusals.reason.push_back("the mesh is too coarse");
  }
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(directory.path()), std::filesystem::directory_iterator());
  };
  for (frame.frame = 0; frame.frame < 25; ++frame.frame) {
    CHECK(xfem::keep_refusals(frame, nullptr, split, directory.path()).size() == 12);
    CHECK(files() == std::min<std::ptrdiff_t>(10 * (frame.frame + 1), 200));
  }
}
