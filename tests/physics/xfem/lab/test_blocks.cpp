#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "laboratory.hpp"
#include "xfem/lab/platens.hpp"
#include "xfem/lab/report.hpp"
#include "xfem/solve_frame.hpp"

using common::LabTestKind;
using laboratory::test_of;

TEST_CASE("a confined block first fails at the Hoek-Brown strength of its confining stress") {
  // sigma_ci = 150 MPa, m = 25: the table of the paper's rock.
  const std::pair<double, double> strengths[] = {{0, 150},    {0.5, 156.62}, {1, 163.02}, {2, 175.21},
                                                 {4, 197.65}, {10, 254.95},  {30, 397.42}};
  common::LabTest test = test_of(LabTestKind::confined, 75);
  test.loading.largest = 1;
  for (const auto& [s3, s1] : strengths) {
    test.loading.confining_stress = s3 * 1e6;
    const xfem::LabResult result = laboratory::run(test);
    const double stress = result.first_failure_load / test.specimen.width;
    INFO("sigma_3 = " << s3 << " MPa");
    CHECK(std::abs(stress / 1e6 - s1) < 0.0051);
    CHECK(std::abs(stress / (s3 * 1e6 + 150e6 * std::sqrt(25 * s3 / 150 + 1)) - 1) < 1e-9);
    CHECK(result.first_failure_mode == xfem::FailureMode::shear);
    // The lateral stress is held: it is s3 at failure, not proportional to the load.
    for (const xfem::Stress& s : result.element_stress) CHECK(std::abs(s.xx - s3 * 1e6) < 1e-9 * stress);
  }
}

TEST_CASE("blocks in compression break at their strength, on the plane of Hoek-Brown") {
  for (const double s3 : {0.0, 4e6, 30e6})
    for (const int nodes : {150, 300}) {
      common::LabTest test = test_of(LabTestKind::confined, nodes);
      test.loading.confining_stress = s3;
      const xfem::LabSetup setup = xfem::lab_setup(test);
      const xfem::LabResult result = xfem::run(setup, test);
      INFO("sigma_3 = " << s3 << " Pa, " << nodes << " nodes");
      CHECK(std::abs(result.breakage_load / *setup.theory_load - 1) < (nodes < 300 ? 0.08 : 0.05));
      REQUIRE(xfem::fracture_angle_degrees(result.breakage));
      CHECK(std::abs(*xfem::fracture_angle_degrees(result.breakage) - setup.theory.back().second) < 5);
    }
}

TEST_CASE("a confined block's plane turns away from the load as the confining stress grows") {
  common::LabTest test = test_of(LabTestKind::confined, 75);
  double previous = 0;
  for (const double s3 : {0.0, 4e6, 30e6}) {
    test.loading.confining_stress = s3;
    const xfem::LabSetup setup = xfem::lab_setup(test);
    const double angle = setup.theory.back().second;
    const double k = 1 + 25 / (2 * std::sqrt(25 * s3 / 150e6 + 1));
    CHECK(angle == Approx(std::atan(1 / std::sqrt(k)) * 180 / 3.14159265358979).epsilon(1e-12));  // pi/4 - phi/2
    CHECK(angle > previous);
    previous = angle;
  }
}

TEST_CASE("a block in direct tension fails where Hoek-Brown meets s1 = 0, and breaks across the load") {
  for (const double m : {9.0, 25.0}) {
    common::LabTest test = test_of(LabTestKind::tension, 150);
    test.material.m_i = m;
    const xfem::LabResult result = laboratory::run(test);
    const double strength = result.first_failure_load / test.specimen.width, sigma_t = 150e6 / m;
    CHECK(strength == Approx(2 * 150e6 / (m + std::sqrt(m * m + 4))).epsilon(1e-9));
    CHECK(strength > 0.98 * sigma_t);
    CHECK(strength < sigma_t);
    CHECK(result.first_failure_mode == xfem::FailureMode::tension);
    CHECK(result.breakage.status == common::ParticleStatus::broken);
    CHECK(result.breakage_load < 1.02 * result.first_failure_load);
  }
}

namespace {

xfem::ParticleModel block_model(double poisson, int nodes) {
  common::LabTest test = test_of(LabTestKind::uniaxial, nodes);
  test.material.poisson_ratio = poisson;
  return {xfem::lab_setup(test).outline, nodes, xfem::elastic_constants(test.material), 0.1};
}

}  // namespace

TEST_CASE("rigid platens on a block that does not bulge press uniformly, whatever their friction") {
  const xfem::ParticleModel model = block_model(0, 150);
  const xfem::IntactModel& elastic = model.elastic;
  const auto loads = xfem::platen_forces(elastic, {1, -0.25}, {1, 0.25}, 0.3, 1000);
  for (const xfem::Stress& s : elastic.stresses(elastic.solve(elastic.nodal_forces(loads)))) {
    CHECK(std::abs(s.yy - 4000) < 4e-6);  // 1000 N over 0.25 m
    CHECK(std::abs(s.xx) + std::abs(s.xy) < 4e-6);
  }
}

TEST_CASE("rigid platens with friction balance, obey Coulomb's law and close without turning") {
  const xfem::ParticleModel model = block_model(0.3, 300);
  const xfem::IntactModel& elastic = model.elastic;
  const double load = 1000;
  for (const double friction : {0.01, 0.1, 0.3, 5.0}) {
    const auto loads = xfem::platen_forces(elastic, {1, -0.25}, {1, 0.25}, friction, load);
    double top = 0, bottom = 0, shear = 0, moment = 0, towards_middle = 0;
    for (const xfem::Load& l : loads) {
      (l.point.y() > 0 ? top : bottom) += l.force.y();
      shear += l.force.x();
      moment += common::cross(l.point, l.force);
      towards_middle -= l.force.x() * l.point.x();
      CHECK(std::abs(l.force.x()) <= friction * std::abs(l.force.y()) + 1e-6 * load);
      CHECK(l.force.y() * l.point.y() < 0);  // it pushes
    }
    CHECK(top == Approx(-load).epsilon(1e-10));
    CHECK(bottom == Approx(load).epsilon(1e-10));
    CHECK(std::abs(shear) < 1e-9 * load);
    CHECK(std::abs(moment) < 1e-9 * load);
    CHECK(towards_middle > 0);  // the platens hold the bulging ends together
    // The face stays plane: up to a rigid motion of the whole block its nodes move alike.
    const Eigen::VectorXd u = elastic.solve(elastic.nodal_forces(loads));
    const auto face = xfem::face_nodes(elastic.mesh(), {1, 0.25});
    const auto& nodes = elastic.mesh().nodes;
    const int a = face.front(), b = face.back();
    const double turn = (u[2 * a + 1] - u[2 * b + 1]) / (nodes[a].x() - nodes[b].x());
    for (const int node : face)
      CHECK(std::abs(u[2 * node + 1] - u[2 * a + 1] - turn * (nodes[node].x() - nodes[a].x())) <
            1e-9 * u.cwiseAbs().maxCoeff());
  }
}

TEST_CASE(
    "friction of the platens makes the block fail first in its middle, where it bulges into tension, on any mesh") {
  common::LabTest test = test_of(LabTestKind::uniaxial, 300);
  test.loading.platen_friction = 0.3;
  const xfem::LabResult result = laboratory::run(test);
  const double smooth = 150e6 * test.specimen.width;
  CHECK(result.first_failure_load < 0.95 * smooth);
  CHECK(result.first_failure_load > 0.8 * smooth);
  CHECK(std::abs(result.first_failure_point.y()) < 0.1 * test.specimen.height);
  const double least = std::accumulate(result.element_stress.begin(), result.element_stress.end(), 0.0,
                                       [](double s, const xfem::Stress& stress) { return std::min(s, stress.xx); });
  CHECK(least < -1e6);  // somewhere it is pulled apart sideways
  test.mesh_nodes = 1200;
  CHECK(laboratory::run(test).first_failure_load == Approx(result.first_failure_load).epsilon(0.02));
}
