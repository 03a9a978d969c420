#include "xfem/elasticity/intact_model.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <tuple>

#include "common/error.hpp"
#include "tests/unit/xfem/outlines.hpp"
#include "xfem/elasticity/loads.hpp"
#include "xfem/elasticity/stiffness.hpp"

using namespace xfem;
using namespace test_outlines;

namespace {

const ElasticConstants kRock{20e9, 0.2};

double largest(const std::vector<Stress>& s) {
  double result = 0;
  for (const Stress& e : s) result = std::max({result, std::abs(e.xx), std::abs(e.yy), std::abs(e.xy)});
  return result;
}

double difference(const Stress& a, const Stress& b) {
  return std::max({std::abs(a.xx - b.xx), std::abs(a.yy - b.yy), std::abs(a.xy - b.xy)});
}

double difference(const std::vector<Stress>& a, const std::vector<Stress>& b) {
  double result = 0;
  for (std::size_t t = 0; t < a.size(); ++t) result = std::max(result, difference(a[t], b[t]));
  return result;
}

/// A point of the boundary at a fraction of its number of edges.
Vec2 on_outline(const Polygon& p, double where) {
  const std::size_t i = static_cast<std::size_t>(where * static_cast<double>(p.size())) % p.size();
  const double t = where * static_cast<double>(p.size()) - std::floor(where * static_cast<double>(p.size()));
  return p[i] + t * (p[(i + 1) % p.size()] - p[i]);
}

/// Random loads near the boundary; the last three balance the others if wanted.
std::vector<Load> random_loads(common::Random& random, const Polygon& p, bool balanced) {
  std::vector<Load> loads;
  Vec2 resultant = Vec2::Zero();
  double moment = 0;
  for (int k = 0; k < 4; ++k) {
    const Load load{on_outline(p, random.uniform()), 1e6 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1))};
    resultant += load.force;
    moment += common::cross(load.point, load.force);
    loads.push_back(load);
  }
  if (balanced) {
    const Vec2 a = on_outline(p, 0.13), b = on_outline(p, 0.57);
    loads.push_back({a, -resultant});
    moment -= common::cross(a, resultant);
    // A couple of forces perpendicular to the line from a to b.
    const Vec2 arm = b - a;
    const Vec2 couple = -moment / arm.squaredNorm() * common::perpendicular(arm);
    loads.push_back({b, couple});
    loads.push_back({a, -couple});
  }
  return loads;
}

}  // namespace

TEST_CASE("A linear displacement field comes out of its tractions on any mesh", "[elasticity]") {
  common::Random random(1);
  for (int k = 0; k < 30; ++k) {
    Polygon p = random_outline(random, random.uniform(0.3, 1));
    if (k % 3 == 0) p = left_part(p, Vec2(0.2, 0.1), Vec2(random.uniform(-1, 1), 1));
    const bool plane_stress = k % 2 == 0;
    const IntactModel model(make_mesh(p, 40 + 20 * k), ElasticConstants{20e9, 0.2, plane_stress});
    const Mesh& mesh = model.mesh();
    const Stress sigma{1e6, -3e6, 2e6};  // compression positive
    // Nodal forces of constant tractions t = -sigma n on every boundary edge.
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(model.dofs());
    const std::vector<int> loop = boundary_loop(mesh);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int a = loop[i], b = loop[(i + 1) % loop.size()];
      const Vec2 n = -common::perpendicular(mesh.nodes[b] - mesh.nodes[a]);  // outward, times the edge length
      const Vec2 t(-(sigma.xx * n.x() + sigma.xy * n.y()), -(sigma.xy * n.x() + sigma.yy * n.y()));
      for (const int node : {a, b}) {
        forces[2 * node] += 0.5 * t.x();
        forces[2 * node + 1] += 0.5 * t.y();
      }
    }
    const Eigen::VectorXd u = model.solve(forces);
    for (const Stress& s : model.stresses(u)) REQUIRE(difference(s, sigma) < 1e-12 * 3e6 * 10);
    // The displacement is linear, with the strain of Hooke's law (tension positive) and a rigid motion.
    const Eigen::Matrix3d d = model.constants().matrix();
    const Eigen::Vector3d strain = d.inverse() * Eigen::Vector3d(-sigma.xx, -sigma.yy, -sigma.xy);
    const auto at = [&](int node) { return Vec2(u[2 * node], u[2 * node + 1]); };
    const Vec2 x0 = mesh.nodes[0], x1 = mesh.nodes[1];
    Eigen::Matrix2d e;
    e << strain[0], 0.5 * strain[2], 0.5 * strain[2], strain[1];
    const Vec2 rest = at(1) - at(0) - e * (x1 - x0);
    const double spin = common::cross(x1 - x0, rest) / (x1 - x0).squaredNorm();
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Vec2 x = mesh.nodes[i] - x0;
      const Vec2 expected = at(0) + e * x + spin * common::perpendicular(x);
      REQUIRE((at(static_cast<int>(i)) - expected).norm() < 1e-11 * strain.norm());
    }
  }
}

TEST_CASE("Balanced loads give the same stress with any determinate supports", "[elasticity]") {
  common::Random random(2);
  for (int k = 0; k < 20; ++k) {
    const Polygon p = random_outline(random, random.uniform(0.5, 1));
    const Mesh mesh = make_mesh(p, 150);
    const int last = static_cast<int>(mesh.nodes.size()) - 1;
    const IntactModel own(mesh, kRock);
    const std::vector<Load> loads = random_loads(random, p, k % 2 == 0);
    const Eigen::VectorXd forces = own.nodal_forces(loads);
    const std::vector<Stress> reference = own.stresses(own.solve(forces));
    const int opposite = static_cast<int>(boundary_loop(mesh).size()) / 2;
    const bool flat =
        std::abs((mesh.nodes[opposite] - mesh.nodes[0]).x()) > std::abs((mesh.nodes[opposite] - mesh.nodes[0]).y());
    for (const std::array<int, 3>& fixed :
         {std::array<int, 3>{0, 1, 2 * opposite + (flat ? 1 : 0)}, std::array<int, 3>{0, 2 * last, 2 * last + 1}}) {
      if (fixed[1] == 2 * last && std::abs((mesh.nodes[last] - mesh.nodes[0]).y()) < 0.3) continue;
      const IntactModel other(mesh, kRock, fixed);
      CHECK(difference(other.stresses(other.solve(forces)), reference) < 1e-12 * largest(reference));
    }
  }
}

TEST_CASE("The mean element stress is the virial of the loads", "[elasticity]") {
  common::Random random(3);
  for (int k = 0; k < 60; ++k) {
    Polygon p = random_outline(random, random.uniform(0.3, 1));
    if (k % 4 == 0) p = left_part(p, Vec2(0.1, 0), Vec2(random.uniform(-1, 1), 1));
    for (Vec2& v : p) v = 0.25 * v + Vec2(0.01, -0.02);
    const IntactModel model(make_mesh(p, 75 + 5 * k), kRock);
    std::vector<Load> loads = random_loads(random, p, k % 2 == 0);
    // Off the boundary, as contact points inside an overlap are.
    if (k % 3 == 0) {
      for (Load& load : loads) load.point -= 0.02 * load.point;
    }
    const double patch = k % 5 < 2 ? 0.0 : 0.05 * (k % 5);
    const Eigen::VectorXd forces = model.nodal_forces(loads, patch);
    const std::vector<Stress> stress = model.stresses(model.solve(forces));
    const Stress mean = mean_stress(model.mesh(), stress);
    const Stress virial = virial_stress(loads, p, patch);
    REQUIRE(difference(mean, virial) <
            1e-12 * std::max({std::abs(virial.xx), std::abs(virial.yy), 0.1 * largest(stress)}));
  }
}

TEST_CASE("The virial of a point loaded disc is the textbook sum", "[elasticity]") {
  const Polygon p = regular(6, 1);
  const std::vector<Load> loads{{Vec2(1, 0), Vec2(-2, 0)}, {Vec2(-1, 0), Vec2(2, 0)}};
  const Stress s = virial_stress(loads, p);
  CHECK(s.xx == Approx(4 / common::area(p)));
  CHECK(s.yy == Approx(0).margin(1e-15));
  CHECK(s.xy == Approx(0).margin(1e-15));
}

TEST_CASE("Nodal forces have neither resultant nor moment, and balanced loads need no body force", "[elasticity]") {
  common::Random random(4);
  for (int k = 0; k < 40; ++k) {
    const Polygon p = random_outline(random, random.uniform(0.4, 1));
    const IntactModel model(make_mesh(p, 80), kRock);
    const bool balanced = k % 2 == 0;
    const std::vector<Load> loads = random_loads(random, p, balanced);
    const double patch = k % 4 < 2 ? 0.0 : 0.1;
    const Eigen::VectorXd forces = model.nodal_forces(loads, patch);
    Vec2 resultant = Vec2::Zero();
    double moment = 0, inner = 0;
    const std::size_t boundary = boundary_loop(model.mesh()).size();
    for (std::size_t i = 0; i < model.mesh().nodes.size(); ++i) {
      const Vec2 f(forces[2 * i], forces[2 * i + 1]);
      resultant += f;
      moment += common::cross(model.mesh().nodes[i], f);
      if (i >= boundary) inner = std::max(inner, f.norm());
    }
    CHECK(resultant.norm() < 1e-8);
    CHECK(std::abs(moment) < 1e-8);
    if (balanced && patch == 0) CHECK(inner < 1e-8);
    CHECK((IntactModel::unbalance(loads) < 1e-15) == balanced);
  }
  CHECK(IntactModel::unbalance({}) == 0);
  const std::vector<Load> single{{Vec2(1, 0), Vec2(3, 4)}};
  CHECK(IntactModel::unbalance(single) == Approx(1));
  const std::vector<Load> couple{{Vec2(1, 1), Vec2(-3, 3)}, {Vec2(-1, -1), Vec2(3, -3)}};
  CHECK(IntactModel::unbalance(couple) == Approx(1));
}

TEST_CASE("A patch spreads a force over its length and keeps resultant and moment", "[elasticity]") {
  const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  // On a straight edge: the mean position is the point, the second moment that of a uniform strip.
  const auto shares = boundary_shares(square, {Vec2(0.4, 0.05), Vec2(1, 2)}, 0.2);
  double sum = 0, first = 0, second = 0;
  for (const BoundaryShare& s : shares) {
    REQUIRE(s.edge == 0);
    sum += s.weight;
    first += s.weight * s.position;
    second += s.weight * (s.position - 0.4) * (s.position - 0.4);
  }
  CHECK(sum == Approx(1).epsilon(1e-14));
  CHECK(first == Approx(0.4).epsilon(1e-14));
  CHECK(second == Approx(0.2 * 0.2 / 12).epsilon(1e-12));
  // Near and round corners the moment about the point is kept while the density stays positive.
  common::Random random(5);
  int kept = 0;
  for (int k = 0; k < 500; ++k) {
    const Polygon p = random_outline(random, 0.8);
    const std::size_t corner = random.index(p.size());
    const Vec2 at = p[corner] + random.uniform(0, 0.05) * (p[(corner + 1) % p.size()] - p[corner]);
    const Vec2 inward = -at.normalized() + 0.5 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
    double weight = 0, moment = 0;
    for (const BoundaryShare& s : boundary_shares(p, {at, inward}, 0.2)) {
      const Vec2 x = p[s.edge] + s.position * (p[(s.edge + 1) % p.size()] - p[s.edge]);
      REQUIRE(s.weight > -1e-14);
      weight += s.weight;
      moment += s.weight * common::cross(x - at, inward);
    }
    kept += std::abs(moment) < 1e-13;
    REQUIRE(weight > 0);
  }
  CHECK(kept > 450);
}

TEST_CASE("Stresses scale, turn and do not depend on the modulus", "[elasticity]") {
  common::Random random(6);
  const Polygon p = random_outline(random, 0.7);
  const Mesh mesh = make_mesh(p, 150);
  const std::vector<Load> loads = random_loads(random, p, false);
  const IntactModel model(mesh, kRock);
  const std::vector<Stress> reference = model.stresses(model.solve(model.nodal_forces(loads)));
  const double size = largest(reference);

  const IntactModel soft(mesh, {1e6, 0.2});
  CHECK(difference(soft.stresses(soft.solve(soft.nodal_forces(loads))), reference) < 1e-12 * size);

  // Twice the size, twice the force per thickness: the same stress.
  Mesh large = mesh;
  for (Vec2& x : large.nodes) x = 2 * x + Vec2(5, 7);
  std::vector<Load> large_loads = loads;
  for (Load& load : large_loads) load = {2 * load.point + Vec2(5, 7), 2 * load.force};
  const IntactModel scaled(connect(large.nodes, large.triangles), kRock);
  CHECK(difference(scaled.stresses(scaled.solve(scaled.nodal_forces(large_loads))), reference) < 1e-11 * size);

  const common::Rotation turn(0.7);
  std::vector<Vec2> nodes = mesh.nodes;
  for (Vec2& x : nodes) x = turn * x;
  std::vector<Load> turned_loads = loads;
  for (Load& load : turned_loads) load = {turn * load.point, turn * load.force};
  const IntactModel turned(connect(nodes, mesh.triangles), kRock);
  const std::vector<Stress> result = turned.stresses(turned.solve(turned.nodal_forces(turned_loads)));
  const double c = turn.cos, s = turn.sin;
  for (std::size_t t = 0; t < result.size(); ++t) {
    const Stress& a = reference[t];
    const Stress expected{c * c * a.xx + s * s * a.yy - 2 * c * s * a.xy,
                          s * s * a.xx + c * c * a.yy + 2 * c * s * a.xy,
                          c * s * (a.xx - a.yy) + (c * c - s * s) * a.xy};
    REQUIRE(difference(result[t], expected) < 1e-11 * size);
  }
}

TEST_CASE("Many right-hand sides give the bits of one", "[elasticity]") {
  common::Random random(7);
  const Polygon p = random_outline(random, 0.7);
  const IntactModel model(make_mesh(p, 100), kRock);
  Eigen::MatrixXd forces(model.dofs(), 7);
  for (int k = 0; k < 7; ++k) forces.col(k) = model.nodal_forces(random_loads(random, p, false));
  const Eigen::MatrixXd together = model.solve(forces);
  for (int k = 0; k < 7; ++k) {
    const Eigen::VectorXd alone = model.solve(Eigen::VectorXd(forces.col(k)));
    for (int i = 0; i < model.dofs(); ++i) REQUIRE(together(i, k) == alone[i]);
    for (const int dof : model.fixed_dofs()) REQUIRE(alone[dof] == 0);
  }
}

TEST_CASE(
    "Averaging keeps a constant, matches a direct sum about boundary edges and centroids, and radius 0 changes nothing",
    "[elasticity]") {
  common::Random random(8);
  const Polygon p = random_outline(random, 0.7);
  const Mesh mesh = make_mesh(p, 150);
  std::vector<Stress> stress(mesh.triangles.size());
  for (Stress& s : stress) s = {random.uniform(), random.uniform(), random.uniform()};
  const std::vector<Stress> same = StressAverage(mesh, 0)(stress);
  CHECK(difference(same, stress) == 0);
  const std::vector<Stress> ones(stress.size(), Stress{1, 2, 3});
  const StressAverage average(mesh, 0.25);
  CHECK(difference(average(ones), ones) < 1e-15 * 10);
  const std::vector<Stress> averaged = average(stress);
  int at_boundary = 0;
  for (std::size_t t = 0; t < stress.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    Vec2 center = mesh.centroid(static_cast<int>(t));
    double longest = 0;
    for (const auto& [from, to, across] : {std::tuple(b, c, 0), std::tuple(c, a, 1), std::tuple(a, b, 2)}) {
      const double length = (mesh.nodes[to] - mesh.nodes[from]).norm();
      if (mesh.neighbours[t][across] >= 0 || length <= longest) continue;
      longest = length;
      center = (mesh.nodes[from] + mesh.nodes[to]) / 2;
    }
    at_boundary += longest > 0;
    double sum = 0, weight = 0;
    for (std::size_t o = 0; o < stress.size(); ++o) {
      if (o != t && (mesh.centroid(static_cast<int>(o)) - center).norm() > 0.25) continue;
      weight += mesh.areas[o];
      sum += mesh.areas[o] * stress[o].yy;
    }
    REQUIRE(averaged[t].yy == Approx(sum / weight).epsilon(1e-13));
  }
  CHECK(at_boundary > 20);
}

TEST_CASE("Elastic constants out of range are refused", "[elasticity]") {
  const Mesh mesh = make_mesh(regular(6, 1), 40);
  CHECK_THROWS_AS(IntactModel(mesh, {0, 0.2}), common::Error);
  CHECK_THROWS_AS(IntactModel(mesh, {1e9, 0.5}), common::Error);
  CHECK_THROWS_AS(IntactModel(mesh, {1e9, -1}), common::Error);
  // Plane strain and plane stress in their textbook forms.
  const Eigen::Matrix3d strain = ElasticConstants{1, 0.25}.matrix();
  CHECK(strain(0, 0) == Approx(1.2));
  CHECK(strain(0, 1) == Approx(0.4));
  CHECK(strain(2, 2) == Approx(0.4));
  const Eigen::Matrix3d stress = ElasticConstants{1, 0.25, true}.matrix();
  CHECK(stress(0, 0) == Approx(16.0 / 15));
  CHECK(stress(0, 1) == Approx(4.0 / 15));
  CHECK(stress(2, 2) == Approx(0.4));
}
