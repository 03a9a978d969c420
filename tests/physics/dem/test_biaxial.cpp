// A whole small test, preparation included: what a sample must satisfy before anyone looks at its strength.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

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

}  // namespace

TEST_CASE("A prepared sample is at rest at its pressure and void ratio, and its energy ledger closes in shear") {
  const common::Scene scene = small_scene();
  const double p = scene.preparation.confining_pressure;
  dem::State start;
  start.particles = dem::generate_assembly(scene.assembly, scene.material.density, scene.seed);
  start.friction = scene.preparation.initial_friction;
  start.next_id = static_cast<std::int64_t>(start.particles.size());
  dem::Engine engine(scene, start);
  dem::Control control;
  dem::Preparation preparation(scene, engine, control);
  while (control.phase != dem::Phase::shear) preparation.step();

  CHECK(engine.health().unbalanced_force < scene.preparation.unbalanced_force);
  const auto stress = dem::mean_stress(engine.state(), dem::ring_area(engine.state()));
  CHECK(stress[0] == Approx(p).epsilon(0.001));
  CHECK(stress[1] == Approx(p).epsilon(0.001));
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
