// The Brazilian disc under two opposite point forces, against Hertz's stress and the Hoek-Brown envelope at the centre:
// first failure at 2 m / (m + sqrt(m^2 + 64)) of pi D sigma_t / 2 (s1 = 3 |s3| there), and a straight diametral path.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/unit/xfem/outlines.hpp"
#include "xfem/breakage.hpp"

using namespace xfem;

namespace {

struct DiscResult {
  double first_failure, breakage;  ///< over theory
  BreakageResult last;
};

/// Raises the load in steps of 1 % from first failure on; cracks persist.
DiscResult crush_disc(int nodes, double m) {
  const double diameter = 0.5;
  // A coarse mesh cannot have more boundary nodes than it has nodes.
  const Polygon outline = test_outlines::regular(nodes < 100 ? 32 : 64, diameter / 2, std::numbers::pi / 2);
  const ParticleModel model(outline, nodes, {20e9, 0.2}, 0.1);
  BreakageParameters parameters;
  parameters.rock = {150e6, m};
  parameters.minimum_area = 0;
  const std::vector<Load> loads{{{0, diameter / 2}, {0, -1e6}}, {{0, -diameter / 2}, {0, 1e6}}};
  const double theory =
      2 * m / (m + std::sqrt(m * m + 64)) * std::numbers::pi * diameter * parameters.rock.tensile_strength() / 2 / 1e6;
  DiscResult result;
  const double first = analyse(model, loads, {}, parameters).min_safety_factor;
  result.first_failure = first / theory;
  std::vector<Crack> cracks;
  for (double factor = first * (1 + 1e-9); factor < 3 * first; factor *= 1.01) {
    parameters.load_factor = factor;
    result.last = analyse(model, loads, cracks, parameters);
    cracks = result.last.cracks;
    result.breakage = factor / theory;
    if (result.last.status == common::ParticleStatus::broken) break;
  }
  return result;
}

}  // namespace

TEST_CASE("A Brazilian disc fails and breaks at the theoretical load along the loaded diameter", "[crack][physics]") {
  struct Expected {
    int nodes;
    double tolerance;  ///< of the load, above theory: the stress is averaged over 0.1 De
    double off_axis;   ///< of the path, in diameters
  };
  for (const double m : {25.0, 11.0}) {
    for (const Expected& expected :
         {Expected{75, 0.25, 0.2}, Expected{150, 0.20, 0.15}, Expected{300, 0.10, 0.08}, Expected{1200, 0.08, 0.06}}) {
      const DiscResult disc = crush_disc(expected.nodes, m);
      INFO("m = " << m << ", " << expected.nodes << " nodes: first failure " << disc.first_failure << ", breakage "
                  << disc.breakage << " of theory");
      CHECK(disc.first_failure > 0.95);
      CHECK(disc.first_failure < 1 + expected.tolerance);
      CHECK(disc.breakage < 1.1 * disc.first_failure);
      CHECK(disc.last.failure_mode == FailureMode::tension);
      REQUIRE(disc.last.status == common::ParticleStatus::broken);
      for (const Vec2& end : *disc.last.path) {
        CHECK(std::abs(end.x()) < expected.off_axis * 0.5);
        CHECK(std::abs(end.y()) > 0.23);
      }
      CHECK(disc.last.path->at(0).y() * disc.last.path->at(1).y() < 0);
      for (const CrackPoint& point : disc.last.cracks[0].points) {
        CHECK(std::abs(point.position.x()) < expected.off_axis * 0.5);
      }
    }
  }
}
