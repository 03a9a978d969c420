#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/unit/xfem/outlines.hpp"
#include "xfem/breakage.hpp"
#include "xfem/crack_state.hpp"

using namespace xfem;
using common::ParticleStatus;

namespace {

const Polygon kBlock{{-0.25, -0.25}, {0.25, -0.25}, {0.25, 0.25}, {-0.25, 0.25}};

ParticleModel block(int nodes = 150, double radius = 0.1) {
  return ParticleModel(kBlock, nodes, {20e9, 0.2}, radius);
}

BreakageParameters without_floor() {
  BreakageParameters parameters;
  parameters.minimum_area = 0;
  return parameters;
}

/// A uniform traction on the faces x = -+0.25 (positive: compression), as forces on the mesh nodes.
std::vector<Load> horizontal_stress(const Mesh& mesh, double stress) {
  std::vector<Load> loads;
  const std::vector<int> loop = boundary_loop(mesh);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2 &a = mesh.nodes[loop[k]], &b = mesh.nodes[loop[(k + 1) % loop.size()]];
    if (a.x() != b.x()) continue;
    const Vec2 force((a.x() < 0 ? 1 : -1) * stress * (b - a).norm() / 2, 0);
    loads.push_back({a, force});
    loads.push_back({b, force});
  }
  return loads;
}

std::vector<Load> opposite_forces(double force) {
  return {{{0, 0.25}, {0, -force}}, {{0, -0.25}, {0, force}}};
}

}  // namespace

TEST_CASE("A particle without load is intact and cannot fail") {
  const ParticleModel model = block();
  for (const std::vector<Load>& loads : {std::vector<Load>{}, std::vector<Load>{{{0.25, 0}, {0, 0}}}}) {
    const BreakageResult result = analyse(model, loads, {}, without_floor());
    CHECK(result.status == ParticleStatus::intact);
    CHECK(std::isinf(result.min_safety_factor));
    CHECK(result.failure_mode == FailureMode::none);
    CHECK(result.mean_stress.yy == 0);
  }
}

TEST_CASE("Below its first failure a particle is intact, above it is not") {
  const ParticleModel model = block();
  BreakageParameters parameters = without_floor();
  const BreakageResult unit = analyse(model, opposite_forces(1e5), {}, parameters);
  REQUIRE(unit.status == ParticleStatus::intact);
  parameters.load_factor = 0.999 * unit.min_safety_factor;
  const BreakageResult below = analyse(model, opposite_forces(1e5), {}, parameters);
  CHECK(below.status == ParticleStatus::intact);
  CHECK(below.min_safety_factor == Approx(1 / 0.999).epsilon(1e-12));
  parameters.load_factor = 1.001 * unit.min_safety_factor;
  const BreakageResult above = analyse(model, opposite_forces(1e5), {}, parameters);
  CHECK(above.status != ParticleStatus::intact);
  CHECK(above.cracks.size() >= 1);
}

TEST_CASE("A load factor is the same as larger loads") {
  const ParticleModel model = block();
  BreakageParameters parameters = without_floor();
  const BreakageResult direct = analyse(model, opposite_forces(8e6), {}, parameters);
  parameters.load_factor = 8;
  const BreakageResult scaled = analyse(model, opposite_forces(1e6), {}, parameters);
  CHECK(direct.status == scaled.status);
  CHECK(direct.min_safety_factor == scaled.min_safety_factor);
  CHECK(direct.growth_steps == scaled.growth_steps);
}

TEST_CASE("Uniaxial tension breaks a block at its tensile strength, across the pull") {
  const ParticleModel model = block();
  BreakageParameters parameters = without_floor();
  const double strength = parameters.rock.tensile_strength();
  // Eq. 4 lies below the cut-off: uniaxial tension fails where s3 + sci sqrt(m s3 / sci + 1) = 0.
  const double m = parameters.rock.m_i;
  const double theory = parameters.rock.sigma_ci * (std::sqrt(m * m + 4) - m) / 2;
  CHECK(theory == Approx(strength).epsilon(0.01));
  const std::vector<Load> loads = horizontal_stress(model.elastic.mesh(), -1e6);
  const BreakageResult unit = analyse(model, loads, {}, parameters);
  CHECK(unit.min_safety_factor * 1e6 == Approx(theory).epsilon(1e-9));
  parameters.load_factor = 1.0001 * unit.min_safety_factor;
  const BreakageResult result = analyse(model, loads, {}, parameters);
  REQUIRE(result.status == ParticleStatus::broken);
  CHECK(result.failure_mode == FailureMode::tension);
  const Vec2 line = result.path->at(1) - result.path->at(0);
  CHECK(std::abs(line.x()) < 0.3 * std::abs(line.y()));
  CHECK(common::area(result.left) + common::area(result.right) == Approx(model.area).epsilon(1e-12));
}

TEST_CASE("A first crack in compression stands at pi/4 - phi/2 from the load") {
  const ParticleModel model = block(300);
  BreakageParameters parameters = without_floor();
  const std::vector<Load> loads = horizontal_stress(model.elastic.mesh(), 1e6);
  const BreakageResult unit = analyse(model, loads, {}, parameters);
  CHECK(unit.min_safety_factor * 1e6 == Approx(parameters.rock.sigma_ci).epsilon(1e-9));
  CHECK(unit.failure_mode == FailureMode::shear);
  // Just short of growth: one element, along the plane but for the clearance from the nodes.
  parameters.load_factor = unit.min_safety_factor * (1 + 1e-12);
  const BreakageResult result = analyse(model, loads, {}, parameters);
  REQUIRE(result.cracks.size() >= 1);
  const double sin_phi = parameters.rock.m_i / (parameters.rock.m_i + 4);
  const double angle = 0.5 * std::acos(sin_phi);
  // The start is among the crack's segments: one runs at this angle.
  double nearest = 10;
  for (const Crack& crack : result.cracks) {
    for (std::size_t i = 1; i < crack.points.size(); ++i) {
      const Vec2 along = crack.points[i].position - crack.points[i - 1].position;
      nearest = std::min(nearest, std::abs(std::atan2(std::abs(along.y()), std::abs(along.x())) - angle));
    }
  }
  CHECK(nearest < 0.02);
}

TEST_CASE("The path does not depend on the size of the particle nor on Young's modulus") {
  common::Random random(4);
  const Polygon outline = test_outlines::random_outline(random, 0.8);
  Polygon large = outline;
  for (Vec2& vertex : large) vertex *= 4;
  const ParticleModel small(outline, 150, {20e9, 0.2}, 0.1);
  const ParticleModel big(large, 150, {5e9, 0.2}, 0.1);
  const Vec2 top(outline[0]), bottom = -outline[0];
  std::vector<Load> loads{{top, -20e6 * top}, {bottom, -20e6 * bottom}};
  BreakageParameters parameters = without_floor();
  const BreakageResult a = analyse(small, loads, {}, parameters);
  for (Load& load : loads) load = {4 * load.point, 4 * load.force};
  const BreakageResult b = analyse(big, loads, {}, parameters);
  CHECK(a.status == b.status);
  CHECK(a.min_safety_factor == Approx(b.min_safety_factor).epsilon(1e-9));
  REQUIRE(a.cracks.size() == b.cracks.size());
  for (std::size_t c = 0; c < a.cracks.size(); ++c) {
    REQUIRE(a.cracks[c].points.size() == b.cracks[c].points.size());
    for (std::size_t i = 0; i < a.cracks[c].points.size(); ++i) {
      CHECK(a.cracks[c].points[i].edge == b.cracks[c].points[i].edge);
    }
  }
}

TEST_CASE("A path that would cut off a chip is not taken, and does not grow there again") {
  // Forces on a corner: whatever fails there is small.
  const ParticleModel model = block(300);
  BreakageParameters parameters = without_floor();
  parameters.minimum_fragment = 0.25;
  const std::vector<Load> loads{{{0.15, 0.25}, {0, -3e6}}, {{0.15, -0.25}, {0, 3e6}}};
  const double first = analyse(model, loads, {}, parameters).min_safety_factor;
  std::vector<Crack> cracks;
  bool chipped = false;
  for (double factor = first * 1.0001; factor < 2 * first; factor *= 1.1) {
    parameters.load_factor = factor;
    const BreakageResult result = analyse(model, loads, cracks, parameters);
    if (result.status == ParticleStatus::broken) {
      CHECK(std::min(common::area(result.left), common::area(result.right)) >= 0.25 * model.area);
      break;
    }
    if (result.reason == "chip") {
      chipped = true;
      CHECK(result.status == ParticleStatus::arrested);
      const auto is_arrested = [](const Crack& crack) {
        return crack.tips[0] == TipState::arrested || crack.tips[1] == TipState::arrested;
      };
      CHECK(std::any_of(result.cracks.begin(), result.cracks.end(), is_arrested));
    }
    cracks = result.cracks;
  }
  CHECK(chipped);
  // The same loads break it if small pieces may be made.
  parameters.minimum_fragment = 0.01;
  parameters.load_factor = 2 * first;
  CHECK(analyse(model, loads, {}, parameters).status == ParticleStatus::broken);
}

TEST_CASE("Two cracks that run into one another count as one path") {
  const ParticleModel model = block(300);
  const Mesh& mesh = model.elastic.mesh();
  const std::array<Vec2, 2> lower{Vec2(-0.03, -0.25), Vec2(-0.03, -0.02)};
  const std::array<Vec2, 2> upper{Vec2(0.03, 0.02), Vec2(0.03, 0.25)};
  const std::vector<Crack> cracks{place_polyline(mesh, lower, {TipState::at_boundary, TipState::active}),
                                  place_polyline(mesh, upper, {TipState::active, TipState::at_boundary})};
  REQUIRE(cracks[0].points.size() > 3);
  REQUIRE(cracks[1].points.size() > 3);
  BreakageParameters parameters = without_floor();
  parameters.max_cracks = 2;
  const BreakageResult result = analyse(model, horizontal_stress(mesh, -5e6), cracks, parameters);
  REQUIRE(result.status == ParticleStatus::broken);
  bool merged = false;
  for (const Crack& crack : result.cracks) {
    merged = merged || crack.tips[0] == TipState::at_crack || crack.tips[1] == TipState::at_crack;
  }
  CHECK(merged);
  CHECK(std::abs(result.path->at(0).y()) == Approx(0.25));
  CHECK(std::abs(result.path->at(0).x()) < 0.06);
  CHECK(std::abs(result.path->at(1).x()) < 0.06);
}

TEST_CASE(
    "Of a path through three cracks the middle one belongs to the path, far as it may lie from the breakage line") {
  const ParticleModel model = block(300);
  const Mesh& mesh = model.elastic.mesh();
  const auto crack = [&](std::vector<Vec2> line, TipState first, TipState last) {
    return place_polyline(mesh, line, {first, last});
  };
  // Pulled sideways, the tips of the first and the last run into the arms of the middle one.
  const std::vector<Crack> cracks{crack({{-0.02, -0.25}, {0.1, -0.1}}, TipState::at_boundary, TipState::active),
                                  crack({{0.07, -0.05}, {0.15, 0}, {0.07, 0.05}}, TipState::active, TipState::active),
                                  crack({{0.1, 0.1}, {-0.02, 0.25}}, TipState::active, TipState::at_boundary)};
  const BreakageResult result = analyse(model, horizontal_stress(mesh, -8e6), cracks, without_floor());
  REQUIRE(result.status == ParticleStatus::broken);
  REQUIRE(std::abs(result.path->at(0).x() + 0.02) < 0.03);
  REQUIRE(std::abs(result.path->at(1).x() + 0.02) < 0.03);
  CHECK(result.path_cracks == std::vector<int>{0, 1, 2});
  // It would pass for a crack of its own by its distance alone.
  for (const int side : {1, -1}) {
    const auto own = inherited_cracks(result.cracks, result.path_cracks, *result.path, side, {0, 0}, mesh.size);
    CHECK(own.empty());
  }
  const int side = result.path->at(0).y() < 0 ? -1 : 1;  // the middle crack's
  CHECK(inherited_cracks(result.cracks, {}, *result.path, side, {0, 0}, mesh.size).size() == 1);
}

TEST_CASE("What cannot be analysed is refused with its reason") {
  const ParticleModel model = block();
  Crack crack;
  crack.points = {point_on_edge(model.elastic.mesh(), 0, 1, 0.5), point_on_edge(model.elastic.mesh(), 2, 3, 0.5)};
  const BreakageResult stored = analyse(model, opposite_forces(1e6), {&crack, 1}, without_floor());
  CHECK(stored.status == ParticleStatus::refused);
  CHECK_THAT(stored.reason, Catch::Contains("stored crack 0"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const BreakageResult broken_loads = analyse(model, opposite_forces(nan), {}, without_floor());
  CHECK(broken_loads.status == ParticleStatus::refused);
}

TEST_CASE("A solution whose mean stress is not the virial of its forces is refused, with the size of the error") {
  ParticleModel model = block();
  const BreakageResult sound = analyse(model, opposite_forces(1e6), {}, without_floor());
  CHECK(sound.status != ParticleStatus::refused);
  // The forces act at the outline, the stress is that of the mesh: 1 % apart, so are the two.
  for (Vec2& vertex : model.outline) vertex *= 1.01;
  const BreakageResult off = analyse(model, opposite_forces(1e6), {}, without_floor());
  CHECK(off.status == ParticleStatus::refused);
  CHECK_THAT(off.reason, Catch::Contains("does not balance the loads, by") && Catch::Contains("expected within 1e-06"));
}

TEST_CASE("A refused particle keeps the cracks that it had") {
  const ParticleModel model = block();
  const Mesh& mesh = model.elastic.mesh();
  const std::array<Vec2, 2> line{Vec2(-0.03, -0.1), Vec2(0.02, 0.1)};
  // The first tip claims to be on the boundary, which an analysis corrects; the second crack fits no mesh.
  std::vector<Crack> cracks{place_polyline(mesh, line, {TipState::active, TipState::active})};
  cracks[0].tips[0] = TipState::at_boundary;
  cracks.emplace_back();
  cracks[1].points = {point_on_edge(mesh, 0, 1, 0.5), point_on_edge(mesh, 2, 3, 0.5)};
  const BreakageResult result = analyse(model, opposite_forces(1e6), cracks, without_floor());
  REQUIRE(result.status == ParticleStatus::refused);
  REQUIRE(result.cracks.size() == 2);
  CHECK(result.cracks[0].tips == cracks[0].tips);
}

TEST_CASE("A tip whose other crack went with the parent's path grows again") {
  const ParticleModel model = block(300);
  const std::array<Vec2, 2> line{Vec2(-0.03, -0.25), Vec2(-0.03, -0.02)};
  const std::vector<Crack> cracks{
      place_polyline(model.elastic.mesh(), line, {TipState::at_boundary, TipState::at_crack})};
  BreakageParameters parameters = without_floor();
  parameters.max_cracks = 1;
  const std::vector<Load> loads = horizontal_stress(model.elastic.mesh(), -4e6);
  CHECK(analyse(model, loads, cracks, parameters).status == ParticleStatus::broken);
}

TEST_CASE("One unbalanced contact is carried by inertia") {
  const ParticleModel model = block();
  const std::vector<Load> loads{{{0, 0.25}, {0, -1e6}}};
  const BreakageResult result = analyse(model, loads, {}, without_floor());
  CHECK(result.unbalance == 1);
  CHECK(std::isfinite(result.min_safety_factor));
  const Stress virial = virial_stress(loads, kBlock);
  CHECK(result.mean_stress.yy == Approx(virial.yy).epsilon(1e-12));
}

TEST_CASE("A sliver whose solution does not balance its loads is refused") {
  // 0.23 m x 1.3 mm: bent, its stiffness spans more digits than a double has.
  const Polygon sliver{{-0.0067694124885841374, 0.021643336146449386},
                       {0.027333812958973681, -0.097757175651479317},
                       {0.016557835775639317, -0.057522106094698773},
                       {-0.027561225122034981, 0.099858891281273676}};
  REQUIRE(common::outline_defect(sliver).empty());
  const std::vector<Load> loads{{sliver[1], {-2268.251543760792, -3905.5770184602757}}};
  const ParticleModel model(sliver, 25, {20e9, 0.2}, 0.1);
  const BreakageResult result = analyse(model, loads, {}, without_floor());
  CHECK(result.status == ParticleStatus::refused);
  CHECK_THAT(result.reason, Catch::Contains("does not balance the loads"));
}
