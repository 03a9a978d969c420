// A whole small test, preparation included: what a sample must satisfy before anyone looks at its strength.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/geometry/overlap.hpp"
#include "dem/history.hpp"
#include "dem/measures.hpp"
#include "dem/stages/generate.hpp"
#include "dem/stages/prepare.hpp"
#include "dem/stages/shear.hpp"

namespace {

common::Scene small_scene() {
  common::Scene scene;
  scene.effects = {true, true, true, false};
  scene.assembly.particles = 300;
  scene.preparation.confining_pressure = 2e6;
  scene.preparation.void_ratio = 0.29;
  scene.shear.axial_strain = 0.02;
  return scene;
}

dem::Engine loose(const common::Scene& scene) {
  dem::State start;
  start.particles = dem::generate_assembly(scene.assembly, scene.material.density, scene.seed);
  start.friction = scene.preparation.initial_friction;
  start.next_id = static_cast<std::int64_t>(start.particles.size());
  return dem::Engine(scene, start);
}

/// Sides of the ring polygon that cross each other.
int crossings(const dem::State& state) {
  const auto at = [&](std::size_t k) { return state.particles.position[state.ring[k % state.ring.size()]]; };
  const auto apart = [](const dem::Vec2& a, const dem::Vec2& b, const dem::Vec2& p, const dem::Vec2& q) {
    return common::cross(b - a, p - a) * common::cross(b - a, q - a) < 0;
  };
  int count = 0;
  for (std::size_t i = 0; i < state.ring.size(); ++i) {
    for (std::size_t j = i + 1; j < state.ring.size(); ++j) {
      count += apart(at(i), at(i + 1), at(j), at(j + 1)) && apart(at(j), at(j + 1), at(i), at(i + 1));
    }
  }
  return count;
}

/// Largest overlap of two boundary particles, as a share of the smaller one's area.
double deepest_overlap(const dem::State& state) {
  const dem::Particles& p = state.particles;
  std::vector<common::Polygon> outlines(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) {
    const common::Rotation turn(p.angle[i]);
    for (const dem::Vec2& v : p.outline(i)) outlines[i].push_back(p.position[i] + turn * v);
  }
  double deepest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!p.boundary[i] || !p.boundary[j]) continue;
      deepest = std::max(deepest, common::overlap(outlines[i], outlines[j]).area / std::min(p.area[i], p.area[j]));
    }
  }
  return deepest;
}

}  // namespace

TEST_CASE(
    "The boundary of a dense sample neither leaks nor jams up to 18 % strain, at the lowest and highest pressure") {
  for (const double pressure : {0.5e6, 4e6}) {
    common::Scene scene;
    scene.effects = {true, true, false, false};
    scene.assembly.particles = 150;
    scene.preparation.confining_pressure = pressure;
    scene.preparation.void_ratio = 0.33;
    scene.shear.axial_strain = 0.18;
    dem::Engine engine = loose(scene);
    dem::Control control;
    dem::Preparation preparation(scene, engine, control);
    while (control.phase != dem::Phase::shear) preparation.step();
    dem::Shear::begin(engine, control);
    dem::Shear shear(scene, engine, control);
    int escaped = 0, crossed = 0;
    double square = 0, rows = 0;
    while (control.axial_strain() < scene.shear.axial_strain) {
      shear.step();
      if (engine.clock().step % 100 != 0) continue;
      const dem::State& state = engine.state();
      const double area = dem::ring_area(state);
      const double error = dem::mean_stress(state, area)[0] / pressure - 1;
      square += error * error;
      rows += 1;
      escaped = std::max(escaped, dem::void_ratios(state).escaped);
      crossed += crossings(state);
    }
    CAPTURE(pressure);
    CHECK(escaped == 0);
    CHECK(crossed == 0);
    CHECK(deepest_overlap(engine.state()) < 0.4);
    // A single contact of so few particles is a larger share of the stress.
    CHECK(std::sqrt(square / rows) < 0.02);
  }
}

TEST_CASE("A prepared sample is at rest at its pressure and void ratio, and its energy ledger closes in shear") {
  const common::Scene scene = small_scene();
  const double p = scene.preparation.confining_pressure;
  dem::Engine engine = loose(scene);
  dem::Control control;
  dem::Preparation preparation(scene, engine, control);
  while (control.phase != dem::Phase::shear) preparation.step();

  CHECK(engine.health().unbalanced_force < scene.preparation.unbalanced_force);
  const auto stress = dem::mean_stress(engine.state(), dem::ring_area(engine.state()));
  CHECK(stress[0] == Approx(p).epsilon(0.001));
  CHECK(stress[1] == Approx(p).epsilon(0.001));
  // At rest the sum over the contacts is that over the forces on the boundary, by the principle of virtual work.
  dem::Vec2 pushed = dem::Vec2::Zero();
  for (std::size_t i = 0; i < engine.state().particles.size(); ++i) {
    if (!engine.state().particles.boundary[i]) continue;
    pushed += engine.forces().force[i].cwiseProduct(engine.state().particles.position[i]);
  }
  pushed /= dem::ring_area(engine.state());
  CHECK(pushed.x() == Approx(stress[0]).epsilon(2e-3));
  CHECK(pushed.y() == Approx(stress[1]).epsilon(2e-3));
  const double e = dem::void_ratio(engine.state(), scene.preparation.definition);
  CHECK(e == Approx(scene.preparation.void_ratio).margin(scene.preparation.void_ratio_tolerance));
  CHECK(dem::shortcomings_of(scene, engine).empty());

  dem::Shear::begin(engine, control);
  dem::Shear shear(scene, engine, control);
  double square = 0;
  double rows = 0;
  double first_bump = 0;
  while (control.axial_strain() < scene.shear.axial_strain) {
    shear.step();
    const double error = dem::mean_stress(engine.state(), dem::ring_area(engine.state()))[0] / p - 1;
    if (control.axial_strain() < 0.002) first_bump = std::max(first_bump, std::abs(error));
    square += error * error;
    rows += 1;
  }
  // Axial strain is 1 - H/H0 of the boundary's affine motion.
  CHECK(control.axial_strain() == Approx(0.02).epsilon(1e-3));
  CHECK(std::sqrt(square / rows) < 0.01);
  CHECK(first_bump < 0.01);
  // The ring was found anew many times on the way: a half step of boundary work lost each time would be 1e-3.
  CHECK(std::abs(dem::energy_residual(engine, control)) < 5e-4 * engine.state().energy.boundary_work);
}
