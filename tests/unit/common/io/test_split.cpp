// split/1: round trips, and what the reader says about files that break the schema.
#include "common/io/split.hpp"
#include "samples.hpp"

using namespace common_test;

TEST_CASE("A split comes back from its file bit for bit") {
  const Directory directory;
  Split written = sample_split();
  const WrittenFile file = write_split(directory / "s.h5", written, {});
  const Split read = read_split(directory / "s.h5");
  CHECK(file.payload_hash == read.payload_hash);
  CHECK(written.payload_hash == read.payload_hash);
  CHECK(read.frame == written.frame);
  CHECK(read.frame_hash == written.frame_hash);
  CHECK(read.config_hash == written.config_hash);
  CHECK(read.particles.id == written.particles.id);
  CHECK(read.particles.status == written.particles.status);
  CHECK(read.particles.mean_stress == written.particles.mean_stress);
  CHECK(std::isnan(read.particles.min_safety_factor[0]));
  CHECK(read.particles.min_safety_factor[1] == 0.9);
  CHECK(read.particles.min_safety_factor[3] == std::numeric_limits<double>::infinity());
  CHECK(read.particles.failure_mode == written.particles.failure_mode);
  CHECK(read.cracks.particle == written.cracks.particle);
  CHECK(read.cracks.point_offset == written.cracks.point_offset);
  CHECK(read.cracks.points == written.cracks.points);
  CHECK(read.cracks.edge == written.cracks.edge);
  CHECK(read.cracks.edge_fraction == written.cracks.edge_fraction);
  CHECK(read.cracks.tip_state == written.cracks.tip_state);
  CHECK(read.broken.parent == written.broken.parent);
  CHECK(read.broken.path == written.broken.path);
  CHECK(read.fragments.id == written.fragments.id);
  CHECK(read.fragments.parent == written.fragments.parent);
  CHECK(read.fragments.vertex_offset == written.fragments.vertex_offset);
  CHECK(read.fragments.vertices == written.fragments.vertices);
  CHECK(read.refusals.particle == written.refusals.particle);
  CHECK(read.refusals.reason == written.refusals.reason);
  CHECK(read.work.screened == 0);
  CHECK(read.work.solved == 3);
  CHECK(read.work.growth_steps == 25);
}

TEST_CASE("A split without any particle comes back") {
  const Directory directory;
  Split empty;
  write_split(directory / "s.h5", empty, {});
  const Split read = read_split(directory / "s.h5");
  CHECK(read.payload_hash == empty.payload_hash);
  CHECK(read.cracks.point_offset == std::vector<std::int64_t>{0});
  CHECK(read.fragments.vertex_offset == std::vector<std::int64_t>{0});
}
