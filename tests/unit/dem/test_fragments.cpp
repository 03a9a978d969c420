// Oracle: the conservation laws of a rigid body that falls in two.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "common/geometry/chord_split.hpp"
#include "dem/engine.hpp"
#include "dem/fragments.hpp"
#include "tests/unit/dem/bodies.hpp"

using bodies::add;
using bodies::box;
using bodies::hexagon;
using bodies::kDensity;
using bodies::sums;
using bodies::Sums;
using common::Polygon;
using common::Vec2;

namespace {

void breaks(common::Split& split, const dem::State& state, std::size_t index, const Vec2& first, const Vec2& last) {
  const auto halves = common::split_by_chord(state.particles.outline(index), first, last);
  std::int64_t id = state.next_id + static_cast<std::int64_t>(split.fragments.id.size());
  split.broken.parent.push_back(state.particles.id[index]);
  split.broken.path.push_back({first, last});
  for (const Polygon& half : {halves.left, halves.right}) {
    split.fragments.id.push_back(id++);
    split.fragments.parent.push_back(state.particles.id[index]);
    split.fragments.vertices.insert(split.fragments.vertices.end(), half.begin(), half.end());
    split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));
  }
}

/// Four hexagons that move and turn; 1 and 3 break.
dem::State cluster() {
  dem::State state;
  for (int k = 0; k < 4; ++k) {
    add(state, hexagon(0.25 + 0.01 * k), Vec2(0.5 * k, 0.1 * k), 0.3 + k);
    state.particles.velocity[k] = Vec2(1 - k, 0.5 * k);
    state.particles.angular_velocity[k] = 2.0 - k;
    state.particles.displacement[k] = Vec2(k, -k);
  }
  state.particles.boundary[0] = 1;
  state.particles.boundary[2] = 1;
  state.ring = {0, 2};
  return state;
}

std::string refusal(const common::Split& split) {
  dem::State state = cluster();
  try {
    dem::apply_split(state, split, kDensity);
  } catch (const common::Error& error) {
    CHECK(error.code() == common::ExitCode::bad_input);
    CHECK(state.particles.size() == 4);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a split conserves mass, area, centre of mass, both momenta and kinetic energy") {
  dem::State state = cluster();
  const Sums before = sums(state.particles);
  common::Split split;
  breaks(split, state, 1, Vec2(0.26, 0), Vec2(-0.1, -0.22516660498395403));
  breaks(split, state, 3, Vec2(0.0, 0.24248711305964282), Vec2(-0.28, 0));
  const dem::SplitReport report = dem::apply_split(state, split, kDensity);
  const Sums after = sums(state.particles);
  CHECK(report.broken == 2);
  CHECK(after.mass == Approx(before.mass).epsilon(1e-14));
  CHECK(after.area == Approx(before.area).epsilon(1e-14));
  CHECK(after.kinetic_energy == Approx(before.kinetic_energy).epsilon(1e-13));
  CHECK(after.angular_momentum == Approx(before.angular_momentum).epsilon(1e-13));
  CHECK((after.momentum - before.momentum).norm() < 1e-13 * before.mass);
  CHECK((after.first_moment - before.first_moment).norm() < 1e-13 * before.mass);
  CHECK(report.momentum_error < 1e-14);
  CHECK(report.area_error < 1e-14);
  CHECK(std::abs(report.kinetic_energy_change) < 1e-12 * before.kinetic_energy);
}

TEST_CASE("fragments stand last, know where they come from, and fill their parent's place") {
  dem::State state = cluster();
  const dem::State old = state;
  common::Split split;
  breaks(split, state, 1, Vec2(0.26, 0), Vec2(-0.1, -0.22516660498395403));
  breaks(split, state, 3, Vec2(0.0, 0.24248711305964282), Vec2(-0.28, 0));
  dem::apply_split(state, split, kDensity);
  const dem::Particles& p = state.particles;
  CHECK(p.id == std::vector<std::int64_t>{0, 2, 4, 5, 6, 7});
  CHECK(p.parent == std::vector<std::int64_t>{-1, -1, 1, 1, 3, 3});
  CHECK(p.root == std::vector<std::int64_t>{0, 2, 1, 1, 3, 3});
  CHECK(p.generation == std::vector<std::int32_t>{0, 0, 1, 1, 1, 1});
  CHECK(p.type == std::vector<std::int32_t>{0, 0, -1, -1, -1, -1});
  CHECK(p.boundary == std::vector<std::uint8_t>{1, 1, 0, 0, 0, 0});
  CHECK(state.ring == std::vector<std::int32_t>{0, 1});
  CHECK(state.next_id == 8);
  CHECK(p.displacement[5] == old.particles.displacement[3]);
  for (std::size_t k = 0; k < split.fragments.id.size(); ++k) {
    const std::size_t i = k + 2;
    const std::size_t parent = k < 2 ? 1 : 3;
    CHECK(common::centroid(p.outline(i)).norm() < 1e-15);
    CHECK(common::outline_defect(p.outline(i)).empty());
    for (std::size_t v = 0; v < p.outline(i).size(); ++v) {
      const Vec2 in_parent = split.fragments.vertices[static_cast<std::size_t>(split.fragments.vertex_offset[k]) + v];
      const Vec2 was = old.particles.position[parent] + common::Rotation(old.particles.angle[parent]) * in_parent;
      const Vec2 is = p.position[i] + common::Rotation(p.angle[i]) * p.outline(i)[v];
      CHECK((is - was).norm() < 1e-15);
    }
  }
  SECTION("and can break again, with the generation counted on") {
    common::Split next;
    const Polygon outline(p.outline(2).begin(), p.outline(2).end());
    breaks(next, state, 2, (outline[0] + outline[1]) / 2, (outline[1] + outline[2]) / 2);
    dem::apply_split(state, next, kDensity);
    CHECK(state.particles.id == std::vector<std::int64_t>{0, 2, 5, 6, 7, 8, 9});
    CHECK(state.particles.generation.back() == 2);
    CHECK(state.particles.root.back() == 1);
  }
}

TEST_CASE("a split without broken particles changes nothing") {
  dem::State state = cluster();
  CHECK(dem::apply_split(state, {}, kDensity).broken == 0);
  CHECK(state.particles.size() == 4);
}

TEST_CASE("contacts of broken particles go to all heirs, in order, with the same force on each body") {
  dem::State state = cluster();
  dem::Contact c;
  c.normal = Vec2(0.6, 0.8);
  c.normal_force = 10;
  c.shear_force = 3;
  c.shear_displacement = -1e-6;
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}, {1, 3}}) {
    c.a = a;
    c.b = b;
    state.contacts.push_back(c);
  }
  common::Split split;
  breaks(split, state, 1, Vec2(0.26, 0), Vec2(-0.26, 0));
  breaks(split, state, 3, Vec2(0.28, 0), Vec2(-0.28, 0));
  const auto report = dem::apply_split(state, split, kDensity);
  // New indices: 0 and 2 became 0 and 1; the fragments of 1 are 2 and 3, those of 3 are 4 and 5.
  std::vector<std::pair<int, int>> pairs;
  for (const auto& contact : state.contacts) pairs.push_back({contact.a, contact.b});
  CHECK(pairs ==
        std::vector<std::pair<int, int>>{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 4}, {2, 5}, {3, 4}, {3, 5}});
  for (const auto& contact : state.contacts) {
    const bool turned = contact.a == 1;  // the particle that was b is now a
    CHECK((contact.force() - (turned ? -1.0 : 1.0) * c.force()).norm() < 1e-14);
    CHECK(contact.shear_displacement == -1e-6);
  }
  CHECK(report.inherited.size() == 8);
  CHECK(std::count_if(report.inherited.begin(), report.inherited.end(), [](auto& h) { return h.group == 2; }) == 4);
}

TEST_CASE("the heirs of one contact carry its shear force together") {
  // A 1 m block, pressed and dragged on a floor, breaks upright at a quarter of its width. For the area law the
  // normal forces of the pieces add up to the block's, so both sums must be unchanged.
  for (const bool block_first : {false, true}) {
    dem::State state;
    const double depth = 1e-4;
    const auto block = [&] { add(state, box(1, 1), Vec2(0, 0.5 - depth), 0); };
    if (block_first) block();
    add(state, box(3, 1), Vec2(0, -0.5), 0);
    if (!block_first) block();
    state.friction = 0.5;
    common::Scene scene;
    scene.effects.friction = true;
    scene.contact.law = common::ContactLaw::area;
    scene.contact.normal_stiffness = 5e9;
    scene.contact.tangential_stiffness = 1e9;
    dem::Engine engine(scene, state);
    REQUIRE(engine.state().contacts.size() == 1);
    engine.edit().contacts[0].shear_displacement = 1e-4;
    engine.restart();
    const double normal = engine.state().contacts[0].normal_force;
    const double shear = engine.state().contacts[0].shear_force;
    REQUIRE(normal == Approx(5e9 * depth));
    REQUIRE(shear == Approx(-1e9 * 1e-4));

    common::Split split;
    breaks(split, engine.state(), block_first ? 0 : 1, Vec2(-0.25, -0.5), Vec2(-0.25, 0.5));
    const auto report = dem::apply_split(engine.edit(), split, kDensity);
    engine.restart();
    dem::share_inherited_history(engine.edit(), report);
    engine.restart();
    double normal_sum = 0, shear_sum = 0;
    std::vector<double> shares;
    for (const auto& contact : engine.state().contacts) {
      if (contact.overlap_area < 1e-12) continue;  // the siblings touch within rounding
      normal_sum += contact.normal_force;
      shear_sum += contact.shear_force;
      shares.push_back(contact.shear_force / shear);
    }
    REQUIRE(shares.size() == 2);
    CHECK(normal_sum == Approx(normal).epsilon(1e-9));
    CHECK(shear_sum == Approx(shear).epsilon(1e-9));
    CHECK(std::min(shares[0], shares[1]) == Approx(0.25).epsilon(1e-9));
  }
}

TEST_CASE("a split that does not fit the assembly is refused and changes nothing") {
  using Catch::Matchers::Contains;
  const dem::State state = cluster();
  common::Split good;
  breaks(good, state, 1, Vec2(0.26, 0), Vec2(-0.26, 0));
  CHECK(refusal(good) == "no error");
  common::Split split = good;
  split.broken.parent[0] = 17;
  CHECK_THAT(refusal(split), Contains("17 does not exist"));
  split = good;
  split.broken.parent[0] = split.fragments.parent[0] = split.fragments.parent[1] = 2;
  CHECK_THAT(refusal(split), Contains("boundary"));
  split = good;
  split.fragments.id[0] = 3;
  CHECK_THAT(refusal(split), Contains("taken"));
  split = good;
  split.fragments.parent[1] = 3;
  CHECK_THAT(refusal(split), Contains("parent 3, expected 1"));
  split = good;
  for (Vec2& vertex : split.fragments.vertices) vertex *= 1.001;
  CHECK_THAT(refusal(split), Contains("area"));
  split = good;
  std::reverse(split.fragments.vertices.begin(), split.fragments.vertices.begin() + split.fragments.vertex_offset[1]);
  CHECK_THAT(refusal(split), Contains("outline of fragment 4"));
  split = good;
  split.fragments.id.pop_back();
  CHECK_THAT(refusal(split), Contains("two for each"));
  split = good;
  breaks(split, state, 1, Vec2(0.26, 0), Vec2(-0.26, 0));
  CHECK_THAT(refusal(split), Contains("breaks twice"));
}
