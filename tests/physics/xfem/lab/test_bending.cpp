#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "laboratory.hpp"

using common::LabTestKind;

namespace {

common::LabTest beam(int nodes) {
  common::LabTest test = laboratory::test_of(LabTestKind::bending, nodes);
  test.specimen.width = 0.5;
  test.specimen.height = 0.1;
  test.specimen.span = 0.4;
  test.loading.patch = 0.05;
  test.loading.largest = 1;
  test.breakage.initiation_radius = 0;
  return test;
}

}  // namespace

TEST_CASE("the correction of a beam's theory for its point force is the strip's Fourier integral") {
  // Filon's strip of depth 1 under a cosine of pressure a on its top: stress 2 a sinh(a) / (sinh(a)^2 - a^2) in its
  // lowest fibre, of which 6 / a^2 is the beam's.
  const auto difference = [](double a) {
    const double s = std::sinh(a);
    return 6 / (a * a) - 2 * a * s / (s * s - a * a);
  };
  const double step = 1e-3, last = 40;
  double integral = 0.01 * difference(0.01);  // smooth and even: constant near 0
  for (double a = 0.01; a < last; a += step)
    integral += step / 6 * (difference(a) + 4 * difference(a + step / 2) + difference(a + step));
  integral += 6 / last;  // the rest of 6 / a^2; the other part has died away
  const double k = integral / std::numbers::pi;

  const common::LabTest test = beam(75);
  const double strength = 2 * 150e6 / (25 + std::sqrt(629.0));
  CHECK(*xfem::lab_setup(test).theory_load == Approx(strength * 0.1 / (1.5 * 4 - k)).epsilon(1e-5));
}

TEST_CASE("a beam's lowest fibre under the load reaches the theory's stress as its mesh grows finer") {
  double error = 1;
  for (const int nodes : {300, 1200, 5000}) {
    const common::LabTest test = beam(nodes);
    const xfem::LabSetup setup = xfem::lab_setup(test);
    const xfem::LabResult result = xfem::run(setup, test);
    const double ratio = result.first_failure_load / *setup.theory_load;
    INFO(nodes << " nodes: " << ratio);
    CHECK(std::abs(ratio - 1) < error);
    error = std::abs(ratio - 1);
    CHECK(result.first_failure_mode == xfem::FailureMode::tension);
    CHECK(result.first_failure_point.y() < -0.04);
    CHECK(std::abs(result.first_failure_point.x()) < 0.015);
  }
  CHECK(error < 0.02);
}
