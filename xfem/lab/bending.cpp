// Three-point bending: a beam of depth d on two supports a span S apart, one force P in the middle of its top.
//
// Beam theory: 3 P S / (2 d^2) in the lowest fibre under the load. The force's own field lowers that by k P / d, from
// the exact solution for a strip under a point force (Filon 1903; Timoshenko & Goodier 1970, articles 24 and 40) less
// its elementary part: k = (1 / pi) int_0^inf (6 / a^2 - 2 a sinh(a) / (sinh(a)^2 - a^2)) da = 0.261383. So
// P = sigma d / (3 S / (2 d) - k) with sigma the tensile strength at s1 = 0. The supports' own fields do not reach the
// middle for S / d >= 2, and what overhangs them carries nothing.
#include <fmt/format.h>

#include "common/error.hpp"
#include "xfem/lab/kinds.hpp"

namespace xfem {

namespace {

constexpr double kPointForceCorrection = 0.261383;
constexpr double kShortestSpan = 2;  ///< in depths

}  // namespace

LabSetup bending_test(const common::LabTest& test) {
  require_loading(test, {"patch"});
  const double length = test.specimen.width, depth = test.specimen.height;
  const double span = test.specimen.span.value_or(0.8 * length);
  if (span > length || span < kShortestSpan * depth)
    throw common::bad_input(
        fmt::format("{}: specimen.span: found {:.4g}, expected one between {:.0f} depths (specimen."
                    "height) = {:.4g} and the beam's length (specimen.width) = {:.4g} [m]",
                    test.file.string(), span, kShortestSpan, kShortestSpan * depth, length));
  LabSetup setup;
  const double x = 0.5 * length, y = 0.5 * depth;
  setup.outline = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  setup.dimensions = {{"width", length}, {"height", depth}, {"span", span}};

  const double strength = uniaxial_tensile_strength(test.material);
  const double elementary = strength * depth * depth / (1.5 * span);
  setup.theory_load = strength * depth / (1.5 * span / depth - kPointForceCorrection);
  setup.theory = {{"first_failure_load", *setup.theory_load},
                  {"elementary_load", elementary},
                  {"tensile_strength", strength},
                  {"fracture_angle_deg", 0}};
  setup.unit_load = *setup.theory_load;
  setup.load_patch = test.loading.patch;
  setup.loads = [y, span, load = setup.unit_load](const IntactModel&) {
    return std::vector<Load>{
        {{0, y}, {0, -load}}, {{-0.5 * span, -y}, {0, 0.5 * load}}, {{0.5 * span, -y}, {0, 0.5 * load}}};
  };
  return setup;
}

}  // namespace xfem
