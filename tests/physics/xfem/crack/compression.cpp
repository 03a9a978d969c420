// Uniform compression of a block, uniaxial and confined, against the Hoek-Brown envelope (Hoek & Brown 1997) and
// Coulomb's failure plane at pi/4 - phi/2 from the major stress, phi from the slope of the envelope.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "xfem/breakage.hpp"

using namespace xfem;

namespace {

constexpr double kWidth = 0.25, kHeight = 0.5;

/// Lateral stress s3, axial stress s1 times 1 + ripple * (a wave across the width that has no symmetry).
std::vector<Load> tractions(const Mesh& mesh, double s3, double s1, double ripple) {
  std::vector<Load> loads;
  const std::vector<int> loop = boundary_loop(mesh);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2 &a = mesh.nodes[loop[k]], &b = mesh.nodes[loop[(k + 1) % loop.size()]];
    const double wave = 1 + ripple * std::cos(4 * (a.x() + b.x()) + 0.7);
    const Vec2 half(-0.5 * s3 * (b.y() - a.y()), 0.5 * s1 * wave * (b.x() - a.x()));
    loads.push_back({a, half});
    loads.push_back({b, half});
  }
  return loads;
}

struct Crushed {
  double first_failure, breakage;  ///< load factors
  double angle;                    ///< of the breakage line to the axis [degrees]
};

/// Raises the load by 1 % at a time from first failure on; cracks persist.
Crushed crush(int nodes, double m, double s3, double s1, double ripple) {
  const double x = kWidth / 2, y = kHeight / 2;
  const ParticleModel model(Polygon{{-x, -y}, {x, -y}, {x, y}, {-x, y}}, nodes, {20e9, 0.2}, 0.1);
  BreakageParameters parameters;
  parameters.rock = {150e6, m};
  parameters.minimum_area = 0;
  const std::vector<Load> loads = tractions(model.elastic.mesh(), s3, s1, ripple);
  Crushed result{analyse(model, loads, {}, parameters).min_safety_factor, 0, 90};
  std::vector<Crack> cracks;
  for (double factor = result.first_failure * (1 + 1e-9); factor < 3 * result.first_failure; factor *= 1.01) {
    parameters.load_factor = factor;
    const BreakageResult state = analyse(model, loads, cracks, parameters);
    cracks = state.cracks;
    if (state.status != common::ParticleStatus::broken) continue;
    result.breakage = factor;
    const Vec2 line = state.path->at(1) - state.path->at(0);
    result.angle = std::atan2(std::abs(line.x()), std::abs(line.y())) * 180 / std::numbers::pi;
    break;
  }
  return result;
}

/// pi/4 - phi/2 in degrees, sin(phi) = (k - 1) / (k + 1), k the slope of the envelope at s3.
double failure_plane_degrees(double m, double s3) {
  const double k = 1 + m / (2 * std::sqrt(m * s3 / 150e6 + 1));
  return (std::numbers::pi / 4 - std::asin((k - 1) / (k + 1)) / 2) * 180 / std::numbers::pi;
}

}  // namespace

TEST_CASE("A block in uniform compression breaks on Coulomb's plane at the Hoek-Brown strength", "[crack][physics]") {
  // s3 and s1 at failure for sigma_ci = 150 MPa, m = 25, as printed in MPa.
  for (const auto& [s3, s1] : {std::pair{0.0, 150.0},
                               {0.5, 156.62},
                               {1.0, 163.02},
                               {2.0, 175.21},
                               {4.0, 197.65},
                               {10.0, 254.95},
                               {30.0, 397.42}}) {
    const double strength = HoekBrown{150e6, 25}.strength(s3 * 1e6);
    CHECK(std::abs(strength - s1 * 1e6) < 0.006e6);
    for (const int nodes : {75, 150, 300, 600}) {
      const Crushed block = crush(nodes, 25, s3 * 1e6, strength, 0);
      INFO(s3 << " MPa, " << nodes << " nodes: first failure " << block.first_failure << ", breakage " << block.breakage
              << " of theory, plane at " << block.angle << " degrees");
      CHECK(std::abs(block.first_failure - 1) < 1e-9);
      CHECK(std::abs(block.breakage - 1) < 0.02);
      CHECK(std::abs(block.angle - failure_plane_degrees(25, s3 * 1e6)) < 1);
    }
  }
}

TEST_CASE("Other rocks break on their own planes", "[crack][physics]") {
  for (const double m : {7.0, 12.0, 32.0}) {
    for (const int nodes : {150, 300}) {
      const Crushed block = crush(nodes, m, 2e6, HoekBrown{150e6, m}.strength(2e6), 0);
      INFO("m = " << m << ", " << nodes << " nodes");
      CHECK(std::abs(block.breakage - 1) < 0.02);
      CHECK(std::abs(block.angle - failure_plane_degrees(m, 2e6)) < 1);
    }
  }
}

TEST_CASE("A shear fracture stays on its plane in a field that is uniform to a few per cent", "[crack][physics]") {
  for (const double ripple : {0.001, 0.01, 0.05}) {
    for (const double s3 : {0.0, 4e6, 30e6}) {
      for (const int nodes : {150, 600}) {
        const Crushed block = crush(nodes, 25, s3, HoekBrown{150e6, 25}.strength(s3), ripple);
        INFO(s3 << " Pa, ripple " << ripple << ", " << nodes << " nodes");
        CHECK(block.breakage < 1.02 * block.first_failure);
        CHECK(block.breakage > 1 - 2.5 * ripple);
        CHECK(std::abs(block.angle - failure_plane_degrees(25, s3)) < 3);
      }
    }
  }
}
