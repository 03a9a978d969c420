// A closed crack at an angle b to a uniaxial compression s: on its line tau = s sin b cos b, p = s sin^2 b. With
// Coulomb friction it sticks if tan(b) >= 1 / mu and otherwise slides under tau - mu p, K_II = (tau - mu p) sqrt(pi a)
// (McClintock & Walsh 1962).
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/unit/xfem/crack/plates.hpp"
#include "xfem/crack/given_crack.hpp"
#include "xfem/crack/stress_intensity.hpp"

using namespace xfem;

namespace {

constexpr double kHalf = 0.12;

struct Block {
  explicit Block(int nodes)
      : outline{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, model(make_mesh(outline, nodes), plates::kRock) {}
  Polygon outline;
  IntactModel model;

  std::vector<Crack> crack(double angle) const {  // to the y axis
    const Vec2 along = kHalf * Vec2(std::sin(angle), std::cos(angle));
    return {place_given_crack(model.mesh(), outline, Vec2(0.5, 0.5) - along, Vec2(0.5, 0.5) + along)};
  }
  CrackedState squeeze(const std::vector<Crack>& cracks, double friction, double stress = 1e6) const {
    CrackedSolver solver(model, plates::traction_forces(model.mesh(), {0, stress, 0}), friction);
    return solver.solve(cracks);
  }
  double sliding(const std::vector<Crack>& cracks, double friction) const {
    const CrackedState state = squeeze(cracks, friction);
    REQUIRE(state.solved);
    // One tip's share of friction scatters with the segments near it; the two tips' mean is that of the whole crack.
    return std::abs(stress_intensity(model, state, cracks, 0, 0)->two +
                    stress_intensity(model, state, cracks, 0, 1)->two) /
           2;
  }
};

}  // namespace

TEST_CASE("A closed crack slides under the shear that friction leaves, and sticks where it leaves none", "[crack]") {
  const Block block(1500);
  for (const double degrees : {30.0, 45.0, 60.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const std::vector<Crack> cracks = block.crack(angle);
    const double shear = 1e6 * std::sin(angle) * std::cos(angle);
    const double pressure = 1e6 * std::sin(angle) * std::sin(angle);
    const double scale = std::sqrt(std::numbers::pi * kHalf);
    for (const double friction : {0.0, 0.2, 0.4, 0.8, 1.2, 2.0}) {
      const double expected = std::max(0.0, shear - friction * pressure) * scale;
      INFO(degrees << " degrees, friction " << friction);
      if (shear <= friction * pressure) CHECK(block.sliding(cracks, friction) < 0.04 * shear * scale);
      CHECK(block.sliding(cracks, friction) == Approx(expected).margin(0.13 * shear * scale));
    }
  }
}

TEST_CASE("A crack that sticks carries load as the uncracked body does", "[crack]") {
  const Block block(600);
  const std::vector<Crack> cracks = block.crack(std::numbers::pi / 4);
  const auto deviation = [&](double friction) {
    double largest = 0;
    for (const Stress& s : block.squeeze(cracks, friction).stress) {
      largest = std::max({largest, std::abs(s.yy / 1e6 - 1), std::abs(s.xx / 1e6), std::abs(s.xy / 1e6)});
    }
    return largest;
  };
  CHECK(deviation(1.1) < 0.02);
  CHECK(deviation(0) > 0.3);
}

TEST_CASE("Friction is linear in the load, and no face carries more than Coulomb's share", "[crack]") {
  const Block block(300);
  const std::vector<Crack> cracks = block.crack(0.6);
  for (const double friction : {0.3, 0.6, 0.9}) {
    const CrackedState once = block.squeeze(cracks, friction);
    const CrackedState twice = block.squeeze(cracks, friction, 2e6);
    REQUIRE(once.q.size() > 0);
    for (Eigen::Index i = 0; i < once.q.size(); ++i) CHECK(twice.q[i] == Approx(2 * once.q[i]).margin(1e-12));
    const std::vector<FaceSegment> faces = face_segments(block.model.mesh(), block.model.gradients(), once.enrichment);
    REQUIRE(once.face_shear.size() == faces.size());
    const double penalty = kFacePenalty * plates::kRock.young_modulus / block.model.mesh().size;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const double pressure = penalty * std::max(0.0, -opening(faces[i], once.q));
      CHECK(std::abs(once.face_shear[i]) <= friction * pressure + 1e-6 * 1e6);
      CHECK(once.face_shear[i] * slip(faces[i], once.q) >= 0);
    }
  }
}

TEST_CASE("Without friction the faces have no shear, and an open crack does not feel it", "[crack]") {
  const Block block(300);
  const std::vector<Crack> cracks = block.crack(0.6);
  CHECK(block.squeeze(cracks, 0).face_shear.empty());
  const CrackedState open = block.squeeze(cracks, 0.6, -1e6), smooth = block.squeeze(cracks, 0, -1e6);
  CHECK(open.closed_segments == 0);
  CHECK(open.q == smooth.q);
}
