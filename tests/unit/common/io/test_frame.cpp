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
