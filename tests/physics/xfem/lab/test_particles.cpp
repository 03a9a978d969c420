#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "laboratory.hpp"

using common::LabTestKind;
using laboratory::test_of;

namespace {

double half_sum(const std::vector<xfem::Load>& loads) {
  double sum = 0;
  for (const xfem::Load& load : loads) sum += load.force.norm();
  return 0.5 * sum;
}

}  // namespace

TEST_CASE("a point load on a regular polygon of many sides is the Brazilian test") {
  common::LabTest disc = test_of(LabTestKind::brazilian, 300);
  disc.specimen.sides = 32;
  common::LabTest particle = test_of(LabTestKind::point_load, 300);
  particle.specimen.outline = xfem::lab_setup(disc).outline;
  for (xfem::Vec2& v : particle.specimen.outline) v = 7 * v + xfem::Vec2(3, -2);  // any scale, anywhere
  const xfem::LabSetup setup = xfem::lab_setup(particle);
  CHECK(*setup.estimate == Approx(*xfem::lab_setup(disc).theory_load).epsilon(1e-12));
  CHECK(xfem::run(setup, particle).first_failure_load ==
        Approx(laboratory::run(disc).first_failure_load).epsilon(1e-6));
}

TEST_CASE("the strength of a particle under a point load does not depend on how its outline is turned") {
  common::LabTest test = test_of(LabTestKind::point_load, 300);
  test.specimen.outline = {{-0.2, -0.15}, {0.1, -0.2}, {0.25, 0.05}, {0.05, 0.25}, {-0.22, 0.1}};
  test.loading.direction = 20;
  const double load = laboratory::run(test).first_failure_load;
  const common::Rotation turn(0.5);
  for (xfem::Vec2& v : test.specimen.outline) v = turn * v;
  test.loading.direction = 20 + 0.5 * 180 / std::numbers::pi;
  CHECK(laboratory::run(test).first_failure_load == Approx(load).epsilon(1e-6));
  const xfem::LabSetup setup = xfem::lab_setup(test);
  CHECK_FALSE(setup.theory_load);
  CHECK(load > 0.5 * *setup.estimate);
  CHECK(load < 2 * *setup.estimate);
}

TEST_CASE("random forces are in balance, push, and stay within their friction") {
  common::LabTest test = test_of(LabTestKind::multi_contact, 75);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    test.seed = seed;
    test.loading.contacts = 2 + static_cast<int>(seed % 6);
    const xfem::LabSetup setup = xfem::lab_setup(test);
    const xfem::ParticleModel model(setup.outline, 75, {20e9, 0.2}, 0.1);
    const auto loads = setup.loads(model.elastic);
    REQUIRE(static_cast<int>(loads.size()) == test.loading.contacts);
    CHECK(half_sum(loads) == Approx(setup.unit_load).epsilon(1e-12));
    CHECK(common::outline_defect(setup.outline).empty());
    CHECK(common::diameter(setup.outline) == Approx(test.specimen.diameter).epsilon(1e-12));
    xfem::Vec2 force = xfem::Vec2::Zero();
    double moment = 0;
    for (const xfem::Load& load : loads) {
      force += load.force;
      moment += common::cross(load.point, load.force);
      xfem::Vec2 normal;
      double nearest = 1;
      for (std::size_t i = 0; i < setup.outline.size(); ++i) {
        const xfem::Vec2 edge = setup.outline[(i + 1) % setup.outline.size()] - setup.outline[i];
        const xfem::Vec2 inwards = common::perpendicular(edge) / edge.norm();
        const double distance = std::abs((load.point - setup.outline[i]).dot(inwards));
        const double along = (load.point - setup.outline[i]).dot(edge) / edge.squaredNorm();
        if (distance < nearest && along > -1e-9 && along < 1 + 1e-9) nearest = distance, normal = inwards;
      }
      CHECK(nearest < 1e-12);
      const double push = load.force.dot(normal);
      CHECK(push > 0);
      CHECK(std::abs(common::cross(normal, load.force)) <= test.loading.friction * push * (1 + 1e-9));
    }
    CHECK(force.norm() < 1e-12 * setup.unit_load);
    CHECK(std::abs(moment) < 1e-12 * setup.unit_load);
  }
}

TEST_CASE("given forces on a given outline are those of the same particle under a point load") {
  common::LabTest point = test_of(LabTestKind::point_load, 150);
  point.specimen.outline = {{-0.2, -0.1}, {0.2, -0.1}, {0.2, 0.1}, {-0.2, 0.1}};
  common::LabTest contacts = point;
  contacts.test = LabTestKind::multi_contact;
  contacts.loading.points = {{0, 0.1}, {0, -0.1}};
  contacts.loading.forces = {{0, -1}, {0, 1}};
  CHECK(laboratory::run(contacts).first_failure_load ==
        Approx(laboratory::run(point).first_failure_load).epsilon(1e-9));
}
