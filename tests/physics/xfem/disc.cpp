// The elastic disc under a diametral point load, against Hertz's closed form (Timoshenko & Goodier, art. 41).
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/unit/xfem/outlines.hpp"
#include "xfem/elasticity/intact_model.hpp"

using namespace xfem;

TEST_CASE("Stress at the centre of a diametrally loaded disc converges to theory", "[elasticity][physics]") {
  const double load = 1e6;
  const double diameter = 0.5;
  const double s1 = 6 * load / (std::numbers::pi * diameter);
  const double s3 = -2 * load / (std::numbers::pi * diameter);
  double last_error = 1;
  for (const int nodes : {300, 1200, 5000}) {
    const common::Polygon outline = test_outlines::regular(128, 0.5 * diameter);
    const IntactModel model(make_mesh(outline, nodes), {20e9, 0.2});
    const std::vector<Load> loads{{Vec2(0, 0.5 * diameter), Vec2(0, -load)}, {Vec2(0, -0.5 * diameter), Vec2(0, load)}};
    const std::vector<Stress> stress = model.stresses(model.solve(model.nodal_forces(loads)));
    // Averaged over a small disc, so that one triangle's place relative to the centre does not matter.
    const StressAverage average(model.mesh(), 0.06 * diameter);
    const Stress center = average(stress)[model.mesh().locate(Vec2(0, 0))];
    const double error = std::max(std::abs(center.yy / s1 - 1), std::abs(center.xx / s3 - 1));
    INFO(nodes << " nodes: s1 " << center.yy / s1 << " s3 " << center.xx / s3 << " of theory");
    CHECK(error < last_error);
    CHECK(std::abs(center.xy) < 0.02 * s1);
    last_error = error;
  }
  CHECK(last_error < 0.02);
}
