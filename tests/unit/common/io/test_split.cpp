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

namespace {

using Ids = std::vector<std::int64_t>;

template <class T>
Item item(const std::vector<T>& values) {
  return array_item(std::span<const T>(values));
}

/// What the reader says after "FILE: " about the sample with one item replaced.
std::string complaint(const Directory& directory, const std::string& path, const std::optional<Item>& replacement) {
  Split split = sample_split();
  write_split(directory / "sound.h5", split, {});
  Contents contents = read_hdf5(directory / "sound.h5");
  contents.erase("@payload_hash");
  if (replacement) {
    contents[path] = *replacement;
  } else {
    contents.erase(path);
  }
  write_atomically(directory / "s.h5", hdf5_image(contents), {});
  Thrown thrown = error_of([&] { read_split(directory / "s.h5"); });
  CHECK(thrown.code == (thrown.text.empty() ? ExitCode::success : ExitCode::bad_input));
  const std::string prefix = (directory / "s.h5").string() + ": ";
  if (thrown.text.starts_with(prefix)) thrown.text.erase(0, prefix.size());
  return thrown.text;
}

}  // namespace

TEST_CASE("A split without a required dataset or attribute is refused by name") {
  const Directory directory;
  for (const char* name :
       {"particles/id", "particles/status", "particles/mean_stress", "particles/min_safety_factor",
        "particles/failure_mode", "cracks/particle", "cracks/point_offset", "cracks/points", "broken/parent",
        "broken/path", "fragments/id", "fragments/parent", "fragments/vertex_offset", "fragments/vertices",
        "refusals/particle", "refusals/reason", "work/screened", "work/solved", "work/growth_steps"}) {
    CHECK(complaint(directory, name, {}) == std::string("dataset ") + name + ": missing");
  }
  for (const char* name : {"schema", "frame", "frame_hash", "config_hash"}) {
    CHECK(complaint(directory, std::string("@") + name, {}) == std::string("attribute ") + name + ": missing");
  }
}

TEST_CASE("Mesh places and tip states of cracks may be absent") {
  const Directory directory;
  for (const char* name : {"cracks/edge", "cracks/edge_fraction", "cracks/tip_state"}) {
    CHECK(complaint(directory, name, {}).empty());
  }
}

TEST_CASE("A spoiled split is refused with dataset, what was found and what was expected") {
  const Directory directory;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto check = [&](const std::string& path, const Item& replacement, const std::string& message) {
    const bool attribute = path[0] == '@';
    CHECK(complaint(directory, path, replacement) ==
          (attribute ? "attribute " + path.substr(1) : "dataset " + path) + ": " + message);
  };
  check("@schema", text_item("frame/1"), "is 'frame/1', expected 'split/1'");
  check("particles/id", item(Ids{3, 9, 9, 40}), "entry 2 is 9 after 9, expected ascending ids");
  check("particles/status", item(std::vector<std::int32_t>{4, 3, 6, 5}), "entry 2 is 6, expected 0 to 5");
  check("particles/status", item(std::vector<std::int32_t>{4, -1, 2, 5}), "entry 1 is -1, expected 0 to 5");
  check("particles/status", item(std::vector<std::int32_t>{4, 3, 2}), "has 3 rows, expected 4");
  check("particles/failure_mode", item(std::vector<std::int32_t>{0, 3, 0, 0}), "entry 1 is 3, expected 0 to 2");
  check("particles/mean_stress", item(std::vector<Vec2>(4, Vec2(0, 0))), "shape is (4, 2), expected (n, 3)");
  check("particles/mean_stress", item(std::vector<std::array<double, 3>>{{0, 0, 0}, {0, nan, 0}, {}, {}}),
        "entry 1 is nan, expected a finite number");
  check("particles/min_safety_factor", item(std::vector<double>{nan, nan, 1, 1}),
        "entry 1 is nan, expected at least 0");
  check("particles/min_safety_factor", item(std::vector<double>{nan, 1, -1, 1}), "entry 2 is -1, expected at least 0");
  check("cracks/particle", item(Ids{17, 3, 41}), "entry 1 is 3 after 17, expected ascending ids");
  check("cracks/particle", item(Ids{17, 17, 912}),
        "entry 2 names particle 912, which is neither in particles/id nor in fragments/id");
  check("cracks/point_offset", item(Ids{0, 2, 5}), "has 3 rows, expected 4");
  check("cracks/point_offset", item(Ids{0, 2, 5, 9}), "ends with 9, but there are 7 rows");
  check("cracks/edge", item(std::vector<std::array<std::int32_t, 2>>(3)), "has 3 rows, expected 7");
  check("cracks/edge_fraction", item(std::vector<double>(8)), "has 8 rows, expected 7");
  check("cracks/tip_state", item(std::vector<std::array<std::int32_t, 2>>(7)), "has 7 rows, expected 3");
  check("broken/parent", item(Ids{8}), "entry 0 names particle 8, which is not in particles/id");
  check("broken/path", item(std::vector<Vec2>(1, Vec2(0, 0))), "shape is (1, 2), expected (n, 2, 2)");
  check("fragments/id", item(Ids{40, 41}), "entry 0 is 40, which is already in particles/id");
  check("fragments/id", item(Ids{41}), "has 1 rows, expected 2");
  check("fragments/id", item(Ids{42, 41}), "entry 1 is 41 after 42, expected ascending ids");
  check("fragments/id", item(Ids{41, std::numeric_limits<std::int64_t>::max()}),
        "entry 1 is 9223372036854775807, expected less than 4611686018427387904");
  check("fragments/parent", item(Ids{9, 17}), "entry 1 is 17, expected 9 as in broken/parent");
  check("fragments/vertex_offset", item(Ids{0, 8, 8}), "entry 2 is 8 after 8, expected an ascending sequence");
  std::vector<Vec2> vertices = sample_split().fragments.vertices;
  std::swap(vertices[4], vertices[6]);
  check("fragments/vertices", item(vertices), "particle 42: " + outline_defect(PolygonView(vertices).subspan(4)));
  check("refusals/particle", item(Ids{41}), "entry 0 names particle 41, which is not in particles/id");
  check("refusals/reason", text_array_item(std::vector<std::string>(2)), "has 2 rows, expected 1");
  check("refusals/reason", item(Ids{1}), "is int64 of shape (1), expected a list of strings");
  check("work/solved", item(Ids{}), "has 0 rows, expected 1");
}
