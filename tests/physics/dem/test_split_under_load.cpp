// What a split does to a loaded pile. Oracle: the area law is neutral to a cut, since the overlap areas of the pieces
// add up; no law may set free more kinetic energy than the elastic energy that was stored.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/geometry/chord_split.hpp"
#include "dem/engine.hpp"
#include "dem/fragments.hpp"
#include "dem/stages/control.hpp"
#include "dem/stages/generate.hpp"
#include "tests/unit/dem/bodies.hpp"

using common::ContactLaw;
using common::Vec2;

namespace {

dem::Engine loaded_pile(const common::Scene& scene) {
  common::AssemblyOptions options;
  options.particles = 60;
  dem::State state;
  state.particles = dem::generate_assembly(options, bodies::kDensity, 8);
  state.next_id = 60;
  state.friction = 0.5;
  dem::Engine engine(scene, state);
  dem::outline_ring(engine);
  for (int k = 0; k < 100000 && engine.state().contacts.size() < 40; ++k) {
    engine.scale_positions(1 - 1e-4);
    engine.step({});
  }
  dem::renew_ring(engine);
  for (int k = 0; k < 20000 && engine.state().contacts.size() < 100; ++k) engine.step({0.2, 0.2});
  for (int k = 0; k < 4000; ++k) engine.step({});
  return engine;
}

/// Every third free particle broken from the middle of its first edge to the middle of the opposite one.
common::Split cut(const dem::State& state) {
  common::Split split;
  const auto& p = state.particles;
  for (std::size_t i = 0; i < p.size(); i += 3) {
    if (p.boundary[i]) continue;
    const auto outline = p.outline(i);
    const std::size_t k = outline.size() / 2;
    const Vec2 first = (outline[0] + outline[1]) / 2;
    const Vec2 last = (outline[k] + outline[(k + 1) % outline.size()]) / 2;
    const auto halves = common::split_by_chord(outline, first, last);
    split.broken.parent.push_back(p.id[i]);
    split.broken.path.push_back({first, last});
    for (const auto& half : {halves.left, halves.right}) {
      split.fragments.id.push_back(state.next_id + static_cast<std::int64_t>(split.fragments.id.size()));
      split.fragments.parent.push_back(p.id[i]);
      split.fragments.vertices.insert(split.fragments.vertices.end(), half.begin(), half.end());
      split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));
    }
  }
  return split;
}

double normal_sum(const dem::State& state) {
  double sum = 0;
  for (const dem::Contact& c : state.contacts) sum += c.normal_force;
  return sum;
}

double overlap_sum(const dem::State& state) {
  double sum = 0;
  for (const dem::Contact& c : state.contacts) sum += c.overlap_area;
  return sum;
}

double shear_sum(const dem::State& state) {
  double sum = 0;
  for (const dem::Contact& c : state.contacts) sum += std::abs(c.shear_force);
  return sum;
}

}  // namespace

TEST_CASE("splits in a loaded pile keep the forces of the area law and do not explode with any law") {
  for (const ContactLaw law : {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential}) {
    common::Scene scene;
    scene.effects.friction = true;
    scene.effects.local_damping = true;
    scene.effects.energy_ledger = true;
    scene.contact.law = law;
    scene.contact.normal_stiffness = law == ContactLaw::area ? 5e9 : 1e9;
    dem::Engine engine = loaded_pile(scene);
    const double normal = normal_sum(engine.state());
    const double overlap = overlap_sum(engine.state());
    const double shear = shear_sum(engine.state());
    const double elastic = dem::elastic_energy(engine.state(), engine.constants());
    REQUIRE(dem::kinetic_energy(engine.state().particles) < 0.01 * elastic);

    const common::Split split = cut(engine.state());
    REQUIRE(split.broken.parent.size() > 5);
    const auto report = dem::apply_split(engine.edit(), split, bodies::kDensity);
    engine.restart();
    dem::share_inherited_history(engine.edit(), report);
    engine.restart();
    const double ratio = normal_sum(engine.state()) / normal;
    const double shear_ratio = shear_sum(engine.state()) / shear;
    const double elastic_after = dem::elastic_energy(engine.state(), engine.constants());
    CAPTURE(static_cast<int>(law), ratio, shear_ratio, elastic_after / elastic);
    CHECK(overlap_sum(engine.state()) == Approx(overlap).epsilon(1e-9));
    if (law == ContactLaw::area) CHECK(ratio == Approx(1).epsilon(1e-9));
    CHECK(ratio > 0.7);
    CHECK(ratio < 1.5);
    CHECK(shear_ratio < 1 + 1e-6);  // never more than the parents carried
    CHECK(shear_ratio > 0.8);

    double most = 0;
    for (int k = 0; k < 3000; ++k) {
      engine.step({});
      most = std::max(most, dem::kinetic_energy(engine.state().particles));
    }
    CAPTURE(most / elastic, dem::kinetic_energy(engine.state().particles) / elastic);
    CHECK(most < std::max(elastic, elastic_after));
    CHECK(dem::kinetic_energy(engine.state().particles) < 0.05 * elastic);
  }
}
