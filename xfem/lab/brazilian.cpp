// Brazilian test: a disc between two opposite forces (Jaeger, Cook & Zimmerman 2007, section 7.5).
//
// At the centre of a disc of diameter D under the line load P, s3 = -2 P / (pi D) and s1 = 3 |s3|. There Hoek-Brown
// fails at P = (pi D sigma_t / 2) 2 m / (m + sqrt(m^2 + 64)): below the textbook's pi D sigma_t / 2, and by shear for
// m < 8. The disc is a regular polygon with its corners on the circle; the forces act at its top and bottom corners,
// exactly D apart, so the number of sides must be even.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "xfem/lab/laboratory.hpp"

namespace xfem {

LabSetup brazilian_test(const common::LabTest& test) {
  const int sides = test.specimen.sides;
  if (sides < 4 || sides % 2 != 0)
    throw common::bad_input(fmt::format("specimen.sides: found {}, expected an even number of at least 4", sides));
  if (test.loading.confining_stress != 0 || test.loading.platen_friction != 0)
    throw common::bad_input("loading: a brazilian test has no confining_stress and no platen_friction");

  LabSetup setup;
  setup.test = "brazilian";
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
