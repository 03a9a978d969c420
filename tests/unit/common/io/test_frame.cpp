// frame/1: round trips, and what the reader says about files that break the schema.
#include <functional>

#include "common/io/frame.hpp"
#include "samples.hpp"

using namespace common_test;

namespace {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(static_cast<const void*>(a.data()), static_cast<const void*>(b.data()),
                                   a.size() * sizeof(T)) == 0);
}

void check_same(const Frame& a, const Frame& b) {
  CHECK(a.frame == b.frame);
  CHECK(a.step == b.step);
  CHECK(a.time == b.time);
  CHECK(a.stage == b.stage);
  CHECK(a.axial_strain == b.axial_strain);
  CHECK(a.seed == b.seed);
  CHECK(a.next_id == b.next_id);
  CHECK(a.friction == b.friction);
  CHECK(a.final == b.final);
  CHECK(a.config_hash == b.config_hash);
  CHECK(a.payload_hash == b.payload_hash);
  const Particles &p = a.particles, &q = b.particles;
  CHECK(same_bits(p.id, q.id));
  CHECK(same_bits(p.parent, q.parent));
  CHECK(same_bits(p.root, q.root));
  CHECK(same_bits(p.generation, q.generation));
  CHECK(same_bits(p.type, q.type));
  CHECK(same_bits(p.position, q.position));
  CHECK(same_bits(p.velocity, q.velocity));
  CHECK(same_bits(p.displacement, q.displacement));
  CHECK(same_bits(p.angle, q.angle));
  CHECK(same_bits(p.angular_velocity, q.angular_velocity));
  CHECK(same_bits(p.mass, q.mass));
  CHECK(same_bits(p.inertia, q.inertia));
  CHECK(same_bits(p.area, q.area));
  CHECK(same_bits(p.boundary, q.boundary));
  CHECK(same_bits(p.vertex_offset, q.vertex_offset));
  CHECK(same_bits(p.vertices, q.vertices));
  const Contacts &c = a.contacts, &d = b.contacts;
  CHECK(same_bits(c.a, d.a));
  CHECK(same_bits(c.b, d.b));
  CHECK(same_bits(c.point, d.point));
  CHECK(same_bits(c.normal, d.normal));
  CHECK(same_bits(c.force, d.force));
  CHECK(same_bits(c.normal_force, d.normal_force));
  CHECK(same_bits(c.shear_force, d.shear_force));
  CHECK(same_bits(c.overlap_area, d.overlap_area));
  CHECK(same_bits(c.overlap_width, d.overlap_width));
  REQUIRE(c.shear_displacement.has_value() == d.shear_displacement.has_value());
  if (c.shear_displacement) CHECK(same_bits(*c.shear_displacement, *d.shear_displacement));
  CHECK(same_bits(a.ring, b.ring));
  for (const auto columns : {&Frame::history, &Frame::checkpoint}) {
    REQUIRE((a.*columns).size() == (b.*columns).size());
    for (std::size_t i = 0; i < (a.*columns).size(); ++i) {
      CHECK((a.*columns)[i].name == (b.*columns)[i].name);
      CHECK((a.*columns)[i].unit == (b.*columns)[i].unit);
      CHECK((a.*columns)[i].description == (b.*columns)[i].description);
      CHECK(same_bits((a.*columns)[i].values, (b.*columns)[i].values));
    }
  }
}

}  // namespace

TEST_CASE("A frame comes back from its file bit for bit") {
  const Directory directory;
  Frame written = sample_frame();
  for (const Stage stage : {Stage::compaction, Stage::relaxation, Stage::confinement, Stage::shear}) {
    written.stage = stage;
    written.final = stage == Stage::shear;
    const WrittenFile file = write_frame(directory / "f.h5", written, {});
    const Frame read = read_frame(directory / "f.h5");
    check_same(written, read);
    CHECK(file.payload_hash == read.payload_hash);
    CHECK(file.bytes == std::filesystem::file_size(directory / "f.h5"));
    CHECK(file.file_hash == hash_hex(read_whole_file(directory / "f.h5")));
    CHECK(!std::filesystem::exists(directory / "f.h5.tmp"));
  }
}

TEST_CASE("A frame without particles, contacts, history and friction comes back") {
  const Directory directory;
  Frame empty;
  write_frame(directory / "f.h5", empty, {});
  const Frame read = read_frame(directory / "f.h5");
  check_same(empty, read);
  CHECK(read.particles.vertex_offset == std::vector<std::int64_t>{0});
  CHECK(!read.contacts.shear_displacement);
}

namespace {

/// A way to spoil a frame file, and what the reader has to say after "FILE: ".
struct Fault {
  std::string message;
  std::function<void(Contents&)> spoil;
};

/// Writes the sample with the fault and no payload hash, as another program would.
Thrown read_spoiled(const Directory& directory, const Contents& sound, const Fault& fault, FrameContent content) {
  Contents contents = sound;
  contents.erase("@payload_hash");
  fault.spoil(contents);
  const std::filesystem::path path = directory / "spoiled.h5";
  write_atomically(path, hdf5_image(contents), {});
  Thrown thrown = error_of([&] { read_frame(path, content); });
  if (thrown.text.starts_with(path.string() + ": ")) thrown.text.erase(0, path.string().size() + 2);
  return thrown;
}

Fault missing(const std::string& path) {
  const bool attribute = path[0] == '@';
  return {(attribute ? "attribute " + path.substr(1) : "dataset " + path) + ": missing",
          [path](Contents& c) { c.erase(path); }};
}

template <class T>
Fault with(const std::string& path, const std::vector<T>& values, const std::string& message) {
  return {message, [=](Contents& c) { c[path] = array_item(std::span<const T>(values)); }};
}

Contents sample_contents(const Directory& directory) {
  Frame frame = sample_frame();
  write_frame(directory / "sound.h5", frame, {});
  return read_hdf5(directory / "sound.h5");
}

using Ids = std::vector<std::int64_t>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Faults that no reader accepts.
std::vector<Fault> faults_for_all() {
  std::vector<Fault> faults;
  for (const char* name :
       {"particles/id", "particles/position", "particles/angle", "particles/boundary", "particles/vertex_offset",
        "particles/vertices", "contacts/a", "contacts/b", "contacts/point", "contacts/force"}) {
    faults.push_back(missing(name));
  }
  std::vector<Vec2> vertices = sample_frame().particles.vertices;
  vertices[5] = {0, -0.3};
  const std::string defect = outline_defect(PolygonView(vertices).subspan(3, 4));
  faults.push_back(with("particles/vertices", vertices, "dataset particles/vertices: particle 9: " + defect));
  vertices[5] = {0, kNan};
  faults.push_back(
      with("particles/vertices", vertices, "dataset particles/vertices: entry 5 is nan, expected a finite number"));
  const std::vector<Fault> others = {
      with("particles/id", Ids{3, 17, 9, 40}, "dataset particles/id: entry 2 is 9 after 17, expected ascending ids"),
      with("particles/id", Ids{3, 9, 9, 40}, "dataset particles/id: entry 2 is 9 after 9, expected ascending ids"),
      with("particles/id", Ids{3, 9, 17, std::numeric_limits<std::int64_t>::max()},
           "dataset particles/id: entry 3 is 9223372036854775807, expected less than 4611686018427387904"),
      with("particles/id", std::vector<float>{3, 9, 17, 40}, "dataset particles/id: type is float32, expected int64"),
      with("particles/position", Ids{1, 2, 3, 4}, "dataset particles/position: shape is (4), expected (n, 2)"),
      with("particles/position", std::vector<std::array<double, 3>>(4),
           "dataset particles/position: shape is (4, 3), expected (n, 2)"),
      with("particles/position", std::vector<std::array<std::int32_t, 2>>(4),
           "dataset particles/position: type is int32, expected float64"),
      with("particles/position", std::vector<Vec2>(3, Vec2(0, 0)),
           "dataset particles/position: has 3 rows, expected 4"),
      with("particles/angle", std::vector<double>{0, 0, kInfinity, 0},
           "dataset particles/angle: entry 2 is inf, expected a finite number"),
      with("particles/angle", std::vector<Vec2>(4, Vec2(0, 0)),
           "dataset particles/angle: shape is (4, 2), expected (n)"),
      with("particles/boundary", Ids{0, 0, 300, 1},
           "dataset particles/boundary: entry 2 is 300, which does not fit uint8"),
      with("particles/vertex_offset", Ids{0, 3, 7, 11}, "dataset particles/vertex_offset: has 4 rows, expected 5"),
      with("particles/vertex_offset", Ids{}, "dataset particles/vertex_offset: has 0 rows, expected 5"),
      with("particles/vertex_offset", Ids{1, 3, 7, 11, 14},
           "dataset particles/vertex_offset: entry 0 is 1, expected 0"),
      with("particles/vertex_offset", Ids{0, 7, 7, 11, 14},
           "dataset particles/vertex_offset: entry 2 is 7 after 7, expected an ascending sequence"),
      with("particles/vertex_offset", Ids{0, 3, 7, 11, 15},
           "dataset particles/vertex_offset: ends with 15, but there are 14 rows"),
      with("contacts/a", Ids{3, 3, 912},
           "dataset contacts/a: entry 2 names particle 912, which is not in particles/id"),
      with("contacts/b", Ids{9, 912, 40},
           "dataset contacts/b: entry 1 names particle 912, which is not in particles/id"),
      with("contacts/b", Ids{9, 3, 40}, "dataset contacts/b: entry 1: particle 3 in contact with itself"),
      with("contacts/b", Ids{9, 17}, "dataset contacts/b: has 2 rows, expected 3"),
      with("contacts/force", std::vector<Vec2>{{0, 0}, {kNan, 0}, {0, 0}},
           "dataset contacts/force: entry 1 is nan, expected a finite number"),
      {"dataset particles/angle: type is string, expected float64",
       [](Contents& c) { c["particles/angle"] = text_array_item(std::vector<std::string>(4, "0")); }},
      {"dataset particles/angle: shape is (), expected (n)",
       [](Contents& c) { c["particles/angle"] = scalar_item(1.0); }},
      {"attribute schema: is 'split/1', expected 'frame/1'", [](Contents& c) { c["@schema"] = text_item("split/1"); }},
      {"attribute schema: type is float64, expected string", [](Contents& c) { c["@schema"] = scalar_item(1.0); }},
      {"attribute stage: is 'rest', expected compaction, relaxation, confinement or shear",
       [](Contents& c) { c["@stage"] = text_item("rest"); }},
      {"attribute time: is nan, expected a finite number", [](Contents& c) { c["@time"] = scalar_item(kNan); }},
      {"attribute final: is 2, expected 0 or 1", [](Contents& c) { c["@final"] = scalar_item(2); }},
      {"attribute frame: has 2 values, expected 1",
       [](Contents& c) { c["@frame"] = array_item<std::int64_t>(Ids{1, 2}); }},
      {"attribute seed: entry 0 is -1, which does not fit uint64", [](Contents& c) { c["@seed"] = scalar_item(-1); }},
      with("@payload_hash", Ids{1}, "damaged or edited: the hash of its payload is ")};
  faults.insert(faults.end(), others.begin(), others.end());
  return faults;
}

/// Faults of a checkpoint; as a mere contact state these files are accepted.
std::vector<Fault> faults_for_dem() {
  std::vector<Fault> faults;
  for (const char* name : {"@schema",
                           "@frame",
                           "@step",
                           "@time",
                           "@stage",
                           "@axial_strain",
                           "@seed",
                           "@next_id",
                           "@friction",
                           "@final",
                           "@config_hash",
                           "particles/parent",
                           "particles/root",
                           "particles/generation",
                           "particles/type",
                           "particles/velocity",
                           "particles/displacement",
                           "particles/angular_velocity",
                           "particles/mass",
                           "particles/inertia",
                           "particles/area",
                           "contacts/normal",
                           "contacts/normal_force",
                           "contacts/shear_force",
                           "contacts/overlap_area",
                           "contacts/overlap_width",
                           "boundary/ring"}) {
    faults.push_back(missing(name));
  }
  const std::vector<Fault> others = {
      with("contacts/normal", std::vector<Vec2>{}, "dataset contacts/normal: has 0 rows, expected 3"),
      with("contacts/normal", std::vector<Vec2>(2, Vec2(0, 1)), "dataset contacts/normal: has 2 rows, expected 3"),
      with("contacts/shear_displacement", std::vector<double>(4),
           "dataset contacts/shear_displacement: has 4 rows, expected 3"),
      with("boundary/ring", Ids{40, 4},
           "dataset boundary/ring: entry 1 names particle 4, which is not in particles/id"),
      with("history/step", std::vector<double>{1}, "dataset history/step: has 1 rows, expected 2"),
      with("checkpoint/energy", std::vector<double>{1, kNan},
           "dataset checkpoint/energy: entry 1 is nan, expected a finite number"),
      with("contacts/a", Ids{9, 3, 9}, "dataset contacts/b: entry 0: particle 9 in contact with itself"),
      with("contacts/a", Ids{17, 3, 9}, "dataset contacts/b: entry 0 is 9, expected more than contacts/a, which is 17"),
      with("contacts/b", Ids{17, 9, 40},
           "dataset contacts/a: entry 1: the pair (3, 9) after (3, 17), expected ascending pairs"),
      with("contacts/b", Ids{9, 9, 40},
           "dataset contacts/a: entry 1: the pair (3, 9) after (3, 9), expected ascending pairs"),
      with("contacts/normal_force", std::vector<double>{0, -1, 2},
           "dataset contacts/normal_force: entry 1 is -1, expected at least 0"),
      with("particles/mass", std::vector<double>{1, 1, 0, 1},
           "dataset particles/mass: entry 2 is 0, expected more than 0"),
      {"attribute next_id: is 40, expected more than the largest particle id 40",
       [](Contents& c) { c["@next_id"] = scalar_item(std::int64_t{40}); }},
      {"attribute step: is 9223372036854775807, expected 0 to 4611686018427387904",
       [](Contents& c) { c["@step"] = scalar_item(std::numeric_limits<std::int64_t>::max()); }}};
  faults.insert(faults.end(), others.begin(), others.end());
  return faults;
}

}  // namespace

TEST_CASE("A spoiled frame is refused with file, dataset, what was found and what was expected") {
  const Directory directory;
  const Contents sound = sample_contents(directory);
  CHECK(read_spoiled(directory, sound, {"", [](Contents&) {}}, FrameContent::everything).text.empty());
  for (const Fault& fault : faults_for_all()) {
    for (const FrameContent content : {FrameContent::contact_state, FrameContent::everything}) {
      const Thrown thrown = read_spoiled(directory, sound, fault, content);
      if (fault.message.starts_with("damaged")) {
        CHECK_THAT(thrown.text, Catch::StartsWith(fault.message));
      } else {
        CHECK(thrown.text == fault.message);
      }
      CHECK(thrown.code == ExitCode::bad_input);
    }
  }
}

TEST_CASE("What only dem needs is asked for only where a whole checkpoint is wanted") {
  const Directory directory;
  const Contents sound = sample_contents(directory);
  for (const Fault& fault : faults_for_dem()) {
    const Thrown thrown = read_spoiled(directory, sound, fault, FrameContent::everything);
    CHECK(thrown.text == fault.message);
    CHECK(thrown.code == ExitCode::bad_input);
    const bool wrong_anyway =
        fault.message.find("has 0 rows") == std::string::npos && fault.message.find("itself") != std::string::npos;
    if (!wrong_anyway) CHECK(read_spoiled(directory, sound, fault, FrameContent::contact_state).text.empty());
  }
}

TEST_CASE("A contact state of another program needs ten datasets and may use other widths of numbers") {
  const Directory directory;
  const Contents sound = sample_contents(directory);
  Contents foreign;
  for (const char* name : {"particles/position", "particles/angle", "particles/vertices", "contacts/a",
                           "contacts/point", "contacts/force"}) {
    foreign[name] = sound.at(name);
  }
  foreign["particles/id"] = array_item<std::int32_t>(std::vector<std::int32_t>{3, 9, 17, 40});
  foreign["particles/boundary"] = array_item<std::int8_t>(std::vector<std::int8_t>{1, 0, 0, 1});
  foreign["particles/vertex_offset"] = array_item<std::uint16_t>(std::vector<std::uint16_t>{0, 3, 7, 11, 14});
  foreign["particles/angle"] = array_item<float>(std::vector<float>{0, 0.5, -7, 1});
  foreign["contacts/b"] = array_item<std::uint64_t>(std::vector<std::uint64_t>{9, 17, 40});
  write_atomically(directory / "foreign.h5", hdf5_image(foreign), {});

  const Frame frame = read_frame(directory / "foreign.h5", FrameContent::contact_state);
  const Frame sample = sample_frame();
  CHECK(frame.particles.id == sample.particles.id);
  CHECK(frame.particles.angle == std::vector<double>{0, 0.5, -7, 1});
  CHECK(frame.particles.boundary == sample.particles.boundary);
  CHECK(frame.particles.vertex_offset == sample.particles.vertex_offset);
  CHECK(same_bits(frame.particles.vertices, sample.particles.vertices));
  CHECK(frame.contacts.b == sample.contacts.b);
  CHECK(frame.particles.mass.empty());
  CHECK(frame.payload_hash == payload_hash(foreign));
  CHECK(error_of([&] { read_frame(directory / "foreign.h5"); }).text ==
        (directory / "foreign.h5").string() + ": attribute schema: missing");
}

TEST_CASE("A contact state is what xfem needs of a frame, and the hash of all of it") {
  const Directory directory;
  Frame written = sample_frame();
  write_frame(directory / "sealed.h5", written, {});
  Contents contents = read_hdf5(directory / "sealed.h5");
  std::vector<std::byte> unsealed = hdf5_image(contents);
  unsealed.resize(unsealed.size() - kSealBytes);
  write_atomically(directory / "unsealed.h5", unsealed, {});
  for (const char* name : {"sealed.h5", "unsealed.h5"}) {
    CAPTURE(name);
    const Frame state = read_frame(directory / name, FrameContent::contact_state);
    CHECK(state.payload_hash == written.payload_hash);
    CHECK(state.frame == written.frame);
    CHECK(state.next_id == written.next_id);
    CHECK(state.particles.id == written.particles.id);
    CHECK(same_bits(state.particles.vertices, written.particles.vertices));
    CHECK(same_bits(state.contacts.force, written.contacts.force));
    CHECK(state.particles.mass.empty());
    CHECK(state.contacts.normal.empty());
    CHECK_FALSE(state.contacts.shear_displacement);
    CHECK(state.ring.empty());
    CHECK(state.history.empty());
    CHECK(state.checkpoint.empty());
  }
}

TEST_CASE("A frame that its reader would refuse is not written") {
  const Directory directory;
  const auto check_refused = [&](const std::string& message, const std::function<void(Frame&)>& spoil) {
    Frame frame = sample_frame();
    spoil(frame);
    const Thrown thrown = error_of([&] { write_frame(directory / "f.h5", frame, {}); });
    CHECK(thrown.text == (directory / "f.h5").string() + ": " + message);
    CHECK(thrown.code == ExitCode::numerical_failure);
    CHECK(std::filesystem::is_empty(directory.path()));
  };
  check_refused("dataset particles/velocity: entry 1 is nan, expected a finite number",
                [](Frame& f) { f.particles.velocity[1].x() = kNan; });
  check_refused("dataset particles/mass: has 3 rows, expected 4", [](Frame& f) { f.particles.mass.pop_back(); });
  check_refused("dataset history/step: stands there twice", [](Frame& f) { f.history[0].name = "step"; });
  check_refused("dataset history/a/b: expected a name without '/' and '@'",
                [](Frame& f) { f.history[0].name = "a/b"; });
  check_refused("attribute time: is inf, expected a finite number", [](Frame& f) { f.time = kInfinity; });
}

TEST_CASE("A frame without dem's own arrays can be written, as a contact state") {
  const Directory directory;
  Frame frame = sample_frame();
  frame.particles.mass.clear();
  frame.contacts.normal.clear();
  write_frame(directory / "f.h5", frame, {});
  check_same(frame, read_frame(directory / "f.h5", FrameContent::particles));
  CHECK(error_of([&] { read_frame(directory / "f.h5"); }).text ==
        (directory / "f.h5").string() + ": dataset particles/mass: missing");
}

TEST_CASE("Columns come back ascending by name, whatever order they were written in") {
  const Directory directory;
  Frame one = sample_frame(), other = sample_frame();
  std::swap(other.history[0], other.history[1]);
  std::swap(other.checkpoint[0], other.checkpoint[1]);
  write_frame(directory / "one.h5", one, {});
  write_frame(directory / "other.h5", other, {});
  CHECK(one.payload_hash == other.payload_hash);
  CHECK(read_whole_file(directory / "one.h5") == read_whole_file(directory / "other.h5"));
  const Frame read = read_frame(directory / "other.h5");
  CHECK(read.history[0].name == "axial_strain");
  CHECK(read.checkpoint[0].name == "energy");
}

TEST_CASE("A particle that has turned too far for a direction is refused in writing and named") {
  const Directory directory;
  Frame frame = sample_frame();
  frame.particles.angle[2] = 1e7;
  const Thrown thrown = error_of([&] { write_frame(directory / "f.h5", frame, {}); });
  CHECK(thrown.code == ExitCode::numerical_failure);
  CHECK_THAT(thrown.text, Catch::Contains("particle 17 has turned by"));
}
