// Blocks under uniform stress: uniaxial and confined compression, direct tension.
//
// Uniaxial: s1 = sigma, s3 = 0; failure at sigma_ci. Confined: the lateral stress s3 acts on all four sides and is
// held, and the axial stress grows from it: failure at s1f = s3 + sigma_ci sqrt(m s3 / sigma_ci + 1) (Eq. 4). The plane
// stands at pi/4 - phi/2 from the load axis, sin(phi) = (k - 1) / (k + 1) with the slope of the envelope at that s3,
// k = 1 + m / (2 sqrt(m s3 / sigma_ci + 1)). Tension: s1 = 0, s3 = -sigma; Eq. 4 fails a little
// before sigma_t = sigma_ci / m, at uniaxial_tensile_strength(), across the load axis.
// Loads are axial stress times width.
//
// Smooth platens are a uniform traction. Rigid platens with friction: see platens.hpp; the stress is not uniform then,
// there is no theory, and the strength between smooth platens stands as the estimate.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "xfem/lab/kinds.hpp"
#include "xfem/lab/platens.hpp"
#include "xfem/lab/tractions.hpp"

namespace xfem {

namespace {

LabSetup block(const common::LabTest& test) {
  LabSetup setup;
  const double x = 0.5 * test.specimen.width, y = 0.5 * test.specimen.height;
  setup.outline = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  setup.dimensions = {{"width", test.specimen.width}, {"height", test.specimen.height}};
  return setup;
}

/// Pressures on the two faces across y and the two across x [Pa].
LabSetup::Loads pressures(const LabSetup& setup, double axial, double lateral) {
  const Vec2 corner = setup.outline[2];
  return [corner, axial, lateral](const IntactModel& model) {
    std::vector<Load> loads;
    for (const double side : {-1.0, 1.0}) {
      add_pressure(model.mesh(), {1, side * corner.y()}, axial, loads);
      if (lateral != 0) add_pressure(model.mesh(), {0, side * corner.x()}, lateral, loads);
    }
    return loads;
  };
}

double plane_angle_degrees(const common::MaterialOptions& material, double s3) {
  const double k = 1 + 0.5 * material.m_i / std::sqrt(material.m_i * s3 / material.sigma_ci + 1);
  return (0.25 * std::numbers::pi - 0.5 * std::asin((k - 1) / (k + 1))) * 180 / std::numbers::pi;
}

void set_theory(LabSetup& setup, double load, double stress, double angle) {
  setup.theory_load = load;
  setup.theory = {{"first_failure_load", load}, {"axial_stress", stress}, {"fracture_angle_deg", angle}};
}

}  // namespace

double uniaxial_tensile_strength(const common::MaterialOptions& material) {
  const double m = material.m_i;
  return 2 * material.sigma_ci / (m + std::sqrt(m * m + 4));
}

LabSetup uniaxial_test(const common::LabTest& test) {
  require_loading(test, {"platen_friction"});
  LabSetup setup = block(test);
  const double strength = test.material.sigma_ci, friction = test.loading.platen_friction;
  setup.unit_load = strength * test.specimen.width;
  if (friction == 0) {
    set_theory(setup, setup.unit_load, strength, plane_angle_degrees(test.material, 0));
    setup.loads = pressures(setup, strength, 0);
    return setup;
  }
  setup.estimate = setup.unit_load;
  setup.estimate_source = "smooth platens: sigma_ci times width";
  setup.loads = [y = setup.outline[2].y(), friction, load = setup.unit_load](const IntactModel& model) {
    return platen_forces(model, {1, -y}, {1, y}, friction, load);
  };
  return setup;
}

LabSetup confined_test(const common::LabTest& test) {
  require_loading(test, {"confining_stress"});
  LabSetup setup = block(test);
  const double s3 = test.loading.confining_stress;
  const double s1 = HoekBrown{test.material.sigma_ci, test.material.m_i}.strength(s3);
  set_theory(setup, s1 * test.specimen.width, s1, plane_angle_degrees(test.material, s3));
  setup.loads = pressures(setup, s1 - s3, 0);
  setup.unit_load = (s1 - s3) * test.specimen.width;
  if (s3 > 0) setup.held = pressures(setup, s3, s3);
  setup.held_load = s3 * test.specimen.width;
  return setup;
}

LabSetup tension_test(const common::LabTest& test) {
  require_loading(test, {});
  LabSetup setup = block(test);
  const double strength = uniaxial_tensile_strength(test.material);
  setup.unit_load = strength * test.specimen.width;
  set_theory(setup, setup.unit_load, -strength, 90);
  setup.theory.emplace_back("tensile_load", test.material.sigma_ci / test.material.m_i * test.specimen.width);
  setup.loads = pressures(setup, -strength, 0);
  return setup;
}

}  // namespace xfem
