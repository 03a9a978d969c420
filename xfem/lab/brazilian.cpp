// Brazilian test: a disc between two opposite forces (Jaeger, Cook & Zimmerman 2007, section 7.5).
//
// At the centre of a disc of diameter D under the line load P, s3 = -2 P / (pi D) and s1 = 3 |s3|. There Hoek-Brown
// fails at P = (pi D sigma_t / 2) 2 m / (m + sqrt(m^2 + 64)): below the textbook's pi D sigma_t / 2, and by shear for
// m < 8. The disc is a regular polygon with its corners on the circle; the forces act at its top and bottom corners,
// exactly D apart, so the number of sides must be even. A mesh has a node at every corner: where its elements are
// larger than the sides that were asked for, the disc gets fewer, so that the mesh stays even.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "xfem/lab/laboratory.hpp"

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

}  // namespace

LabSetup brazilian_test(const common::LabTest& test) {
  if (test.specimen.sides < 4 || test.specimen.sides % 2 != 0)
    throw common::bad_input(
        fmt::format("specimen.sides: found {}, expected an even number of at least 4", test.specimen.sides));
  if (test.loading.confining_stress != 0 || test.loading.platen_friction != 0)
    throw common::bad_input("loading: a brazilian test has no confining_stress and no platen_friction");

  LabSetup setup;
  setup.test = "brazilian";
  const int sides = sides_for(test.mesh_nodes, test.specimen.sides);
  const double radius = 0.5 * test.specimen.diameter;
  for (int k = 0; k < sides; ++k) {
    const Vec2 corner = radius * (common::Rotation(2 * std::numbers::pi * k / sides) * Vec2{0, -1});
    setup.outline.push_back(2 * k == sides ? Vec2{0, radius} : corner);
  }

  const double m = test.material.m_i;
  const double tensile = std::numbers::pi * radius * test.material.sigma_ci / m;
  setup.theory_load = tensile * 2 * m / (m + std::sqrt(m * m + 64));
  setup.theory = {{"first_failure_load", setup.theory_load},
                  {"tensile_load", tensile},
                  {"tensile_strength", test.material.sigma_ci / m},
                  {"fracture_angle_deg", 0}};
  setup.unit_load = setup.theory_load;
  setup.load_patch = test.loading.patch;
  setup.loads = [radius, load = setup.unit_load](const Mesh&) {
    return std::vector<Load>{{{0, radius}, {0, -load}}, {{0, -radius}, {0, load}}};
  };
  return setup;
}

}  // namespace xfem
