// Brazilian test: a disc between two opposite forces (Jaeger, Cook & Zimmerman 2007, section 7.5).
//
// A force P that is spread evenly, as vertical traction, over an arc of half-angle a at either end stresses the centre
// of a disc of diameter D by s1 = b1 2 P / (pi D), s3 = -b3 2 P / (pi D). Of the normal traction there only the mean
// and the second harmonic reach the centre (Michell's series: no other term of the disc is uniform there), so
//   b1 = (sin a + sin 3a / 3) / a + sin a / a,  b3 = (sin a + sin 3a / 3) / a - sin a / a;  3 and 1 for a point force.
// With x = 2 P / (pi D sigma_ci), Hoek-Brown (Eq. 4) reads ((b1 + b3) x)^2 = 1 - m b3 x, so
//   x = 2 / (m b3 + sqrt(m^2 b3^2 + 4 (b1 + b3)^2)): for a point force P = (pi D sigma_t / 2) 2 m / (m + sqrt(m^2 +
//   64)).
// That holds for every m; the mode is tension for m >= 8, where Fairhurst's tangent point m + 1 - 2 sqrt(m + 1) reaches
// 3, and shear below.
//
// The disc is a regular polygon with its corners on the circle; the forces act at its top and bottom corners, exactly D
// apart, so the number of sides must be even. A mesh has a node at every corner: where its elements are larger than the
// sides that were asked for, the disc gets fewer, so that the mesh stays even. A polygon of few sides is held to the
// disc's theory; how far it is from it, the README says.
#include "xfem/lab/brazilian.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "xfem/lab/kinds.hpp"

namespace xfem {

namespace {

/// The largest even number of sides that are no shorter than an element of a mesh of `nodes` nodes, but at most
/// `wanted`. From n = A / (h^2 sqrt(3/4)) + P / (2 h) for equilateral elements of size h in area A and perimeter P.
int sides_for(int nodes, int wanted) {
  const double pi = std::numbers::pi;  // perimeter of the circle of diameter 1, whose area is pi / 4
  const double cells = 0.25 * pi / std::sqrt(0.75);
  const double h = (0.5 * pi + std::sqrt(0.25 * pi * pi + 4 * nodes * cells)) / (2 * nodes);
  return std::min(wanted, std::max(4, 2 * static_cast<int>(0.5 * pi / h)));
}

/// Load at which a central crack 2 a along the load axis grows, K_I = P / sqrt(pi R) sqrt(a / R) N(a / R) = K_Ic; empty
/// for other cracks or loads and without a declared toughness. N through 1.060, 1.243, 1.578 at a / R = 0.2, 0.4, 0.6
/// (Atkinson, Smelser & Sanchez 1982), even in a / R, within 0.1 % of their values between.
std::optional<double> cracked_disc_load(const common::LabTest& test) {
  const bool point_loads = test.loading.patch == 0 || test.breakage.literal;
  if (!test.effects.toughness || test.specimen.cracks.size() != 1 || !point_loads) return std::nullopt;
  const auto& [from, to] = test.specimen.cracks.front();
  const double radius = 0.5 * test.specimen.diameter;
  const double half = 0.5 * std::abs(to.y() - from.y());
  if (std::abs(from.x()) + std::abs(to.x()) + std::abs(from.y() + to.y()) > 1e-9 * radius) return std::nullopt;
  const double y = half * half / (radius * radius);
  if (half < 0.1 * radius || half > 0.6001 * radius) return std::nullopt;
  const double n = 1 + y * (1.5 + (y - 0.04) * (0.15625 + 0.86806 * (y - 0.16)));
  return test.material.fracture_toughness * std::sqrt(std::numbers::pi * radius) / (std::sqrt(half / radius) * n);
}

}  // namespace

double disc_load(const common::MaterialOptions& material, double diameter, double arc) {
  double mean = 1, second = 2;  // harmonics of the normal traction
  if (arc > 0) {
    const double a = arc / diameter;
    mean = std::sin(a) / a;
    second = (std::sin(a) + std::sin(3 * a) / 3) / a;
  }
  const double b1 = second + mean, b3 = second - mean;
  const double tension = material.m_i * b3, deviator = b1 + b3;
  const double x = 2 / (tension + std::sqrt(tension * tension + 4 * deviator * deviator));
  return 0.5 * std::numbers::pi * diameter * material.sigma_ci * x;
}

LabSetup brazilian_test(const common::LabTest& test) {
  require_loading(test, {"patch"});
  if (test.specimen.sides < 4 || test.specimen.sides % 2 != 0)
    throw common::bad_input(
        fmt::format("specimen.sides: found {}, expected an even number of at least 4", test.specimen.sides));

  LabSetup setup;
  const int sides = sides_for(test.mesh_nodes, test.specimen.sides);
  const double radius = 0.5 * test.specimen.diameter;
  for (int k = 0; k < sides; ++k) {
    const Vec2 corner = radius * (common::Rotation(2 * std::numbers::pi * k / sides) * Vec2{0, -1});
    setup.outline.push_back(2 * k == sides ? Vec2{0, radius} : corner);
  }
  setup.dimensions = {{"diameter", test.specimen.diameter}, {"sides", sides}};

  const double strength = test.material.sigma_ci / test.material.m_i;
  // A literal test has point loads, whatever is asked for.
  const double patch = test.breakage.literal ? 0 : test.loading.patch;
  const double arc = patch * common::equivalent_diameter(common::area(setup.outline));
  setup.theory_load = disc_load(test.material, test.specimen.diameter, arc);
  setup.theory = {{"first_failure_load", *setup.theory_load},
                  {"tensile_load", std::numbers::pi * radius * strength},
                  {"tensile_strength", strength},
                  {"fracture_angle_deg", 0}};
  setup.unit_load = *setup.theory_load;
  if (!test.specimen.cracks.empty()) {
    setup.theory_load = cracked_disc_load(test);
    setup.theory.clear();
    if (setup.theory_load) setup.theory = {{"first_failure_load", *setup.theory_load}, {"fracture_angle_deg", 0}};
    setup.estimate = disc_load(test.material, test.specimen.diameter, arc);
    setup.estimate_source = "the disc without its cracks";
  }
  setup.load_patch = test.loading.patch;
  setup.loads = [radius, load = setup.unit_load](const IntactModel&) {
    return std::vector<Load>{{{0, radius}, {0, -load}}, {{0, -radius}, {0, load}}};
  };
  return setup;
}

}  // namespace xfem
