// Oracle: the state itself, bit for bit, and the run that was not interrupted.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>

#include "common/error.hpp"
#include "dem/checkpoint.hpp"
#include "dem/engine.hpp"
#include "dem/stages/control.hpp"
#include "dem/stages/generate.hpp"
#include "tests/unit/dem/bodies.hpp"
#include "tests/unit/scratch_folder.hpp"

using common::Vec2;
namespace fs = std::filesystem;

namespace {

common::Scene test_scene() {
  common::Scene scene;
  scene.effects.friction = true;
  scene.effects.local_damping = true;
  scene.effects.energy_ledger = true;
  scene.assembly.particles = 60;
  return scene;
}

/// A pile under way: contacts, shear histories, energies, velocities, all of them not zero.
dem::Engine pile(const common::Scene& scene) {
  dem::State state;
  state.particles = dem::generate_assembly(scene.assembly, scene.material.density, 4);
  state.next_id = 60;
  state.friction = 0.5;
  dem::Engine engine(scene, state);
  for (int k = 0; k < 100000 && engine.state().contacts.size() < 40; ++k) {
    engine.scale_positions(common::Vec2::Constant(1 - 1e-4));
    engine.step({});
  }
  dem::renew_ring(engine);
  for (int k = 0; k < 800; ++k) engine.step({0.1, 0.3});
  return engine;
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void check_same(const dem::State& a, const dem::State& b) {
  const dem::Particles& p = a.particles;
  const dem::Particles& q = b.particles;
  CHECK((same(p.id, q.id) && same(p.parent, q.parent) && same(p.root, q.root)));
  CHECK((same(p.generation, q.generation) && same(p.type, q.type) && same(p.boundary, q.boundary)));
  CHECK((same(p.position, q.position) && same(p.velocity, q.velocity) && same(p.displacement, q.displacement)));
  CHECK((same(p.angle, q.angle) && same(p.angular_velocity, q.angular_velocity)));
  CHECK((same(p.mass, q.mass) && same(p.inertia, q.inertia) && same(p.area, q.area)));
  CHECK((same(p.vertex_offset, q.vertex_offset) && same(p.vertices, q.vertices)));
  CHECK(a.ring == b.ring);
  CHECK(a.step == b.step);
  CHECK(a.time == b.time);
  CHECK(a.time_step == b.time_step);
  CHECK(a.friction == b.friction);
  CHECK(a.next_id == b.next_id);
  CHECK(std::memcmp(&a.energy, &b.energy, sizeof a.energy) == 0);
  REQUIRE(a.contacts.size() == b.contacts.size());
  bool equal = true;
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    const dem::Contact& c = a.contacts[i];
    const dem::Contact& d = b.contacts[i];
    equal &= c.a == d.a && c.b == d.b && c.point == d.point && c.normal == d.normal &&
             c.normal_force == d.normal_force && c.shear_force == d.shear_force &&
             c.shear_displacement == d.shear_displacement && c.overlap_area == d.overlap_area &&
             c.overlap_width == d.overlap_width;
  }
  CHECK(equal);
}

}  // namespace

TEST_CASE("a state comes back from its frame file bit for bit") {
  const common::Scene scene = test_scene();
  const dem::Engine engine = pile(scene);
  REQUIRE(engine.state().contacts.size() > 20);
  REQUIRE(engine.state().energy.friction > 0);
  common::Frame frame = dem::to_frame(engine.state(), scene, common::Stage::shear);
  check_same(engine.state(), dem::to_state(frame));
  const scratch::Folder folder;
  const fs::path path = folder / "frame.h5";
  common::write_frame(path, frame, {});
  check_same(engine.state(), dem::to_state(common::read_frame(path)));
}

TEST_CASE("an engine made from a checkpoint goes on like the one that was not interrupted") {
  const common::Scene scene = test_scene();
  dem::Engine engine = pile(scene);
  const common::Frame frame = dem::to_frame(engine.state(), scene, common::Stage::shear);
  dem::Engine resumed(scene, dem::to_state(frame));
  engine.restart();  // as at every frame
  for (int k = 0; k < 300; ++k) {
    engine.step({0.1, 0.3});
    resumed.step({0.1, 0.3});
  }
  check_same(engine.state(), resumed.state());
}

TEST_CASE("scenes without friction write no shear history") {
  common::Scene scene = test_scene();
  scene.effects.friction = false;
  const dem::Engine engine = pile(scene);
  const common::Frame frame = dem::to_frame(engine.state(), scene, common::Stage::shear);
  CHECK_FALSE(frame.contacts.shear_displacement.has_value());
  check_same(engine.state(), dem::to_state(frame));
}

TEST_CASE("a checkpoint that lacks a value is refused by the name of the dataset") {
  const common::Scene scene = test_scene();
  const common::Frame good = dem::to_frame(pile(scene).state(), scene, common::Stage::shear);
  REQUIRE(good.checkpoint.size() > 3);
  for (std::size_t k = 0; k < good.checkpoint.size(); ++k) {
    for (const bool doubled : {false, true}) {
      common::Frame bad = good;
      if (doubled) {
        bad.checkpoint[k].values.push_back(1);
      } else {
        bad.checkpoint.erase(bad.checkpoint.begin() + static_cast<std::ptrdiff_t>(k));
      }
      CHECK_THROWS_WITH(dem::to_state(bad), Catch::Matchers::Contains("checkpoint/" + good.checkpoint[k].name));
      CHECK_THROWS_AS(dem::to_state(bad), common::Error);
    }
  }
  common::Frame bad = good;
  bad.ring[0] = 1000;
  CHECK_THROWS_WITH(dem::to_state(bad), Catch::Matchers::Contains("1000"));
}

TEST_CASE("an outline with more vertices than a contact can take is refused, not overrun") {
  dem::State state;
  common::Polygon outline;
  for (int k = 0; k < 65; ++k) outline.push_back(common::Rotation(k * 6.283185307179586 / 65) * Vec2(0.2, 0));
  bodies::add(state, outline, Vec2(0, 0));
  CHECK_THROWS_WITH(dem::Engine(test_scene(), state), Catch::Matchers::Contains("65 vertices, expected at most 64"));
}
