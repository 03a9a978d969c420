#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "../../../unit/xfem/sample_frame.hpp"
#include "common/error.hpp"
#include "laboratory.hpp"
#include "xfem/lab/report.hpp"

using common::LabTestKind;
using laboratory::test_of;

TEST_CASE("a block between smooth platens first fails at its uniaxial strength") {
  for (int nodes : {75, 300}) {
    const common::LabTest test = test_of(LabTestKind::uniaxial, nodes);
    const xfem::LabSetup setup = xfem::uniaxial_test(test);
    const xfem::LabResult result = xfem::run(setup, test);
    CHECK(std::abs(result.first_failure_load / (150e6 * test.specimen.width) - 1) < 1e-9);
    for (const xfem::Stress& s : result.element_stress) {
      CHECK(std::abs(s.yy - 150e6) < 150e6 * 1e-9);
      CHECK(std::abs(s.xx) + std::abs(s.xy) < 150e6 * 1e-9);
    }
    CHECK(result.breakage.failure_mode == xfem::FailureMode::shear);
  }
}

TEST_CASE("a disc under two forces first fails near Hondros' stress at its centre") {
  for (const auto& [nodes, ratio] : {std::pair{75, 1.02}, {150, 1.05}, {300, 1.05}}) {
    const common::LabTest test = test_of(LabTestKind::brazilian, nodes);
    const xfem::LabSetup setup = xfem::brazilian_test(test);
    const double tensile = std::numbers::pi * 0.5 * 6e6 / 2;
    CHECK(*setup.theory_load == Approx(tensile * 50 / (25 + std::sqrt(25.0 * 25 + 64))).epsilon(1e-14));
    const xfem::LabResult result = xfem::run(setup, test);
    INFO(nodes << " nodes: first failure " << result.first_failure_load / *setup.theory_load << ", breakage "
               << result.breakage_load / *setup.theory_load);
    CHECK(std::abs(result.first_failure_load / *setup.theory_load - ratio) < 0.02);
    CHECK(result.breakage.failure_mode == xfem::FailureMode::tension);
    CHECK(result.breakage.status == common::ParticleStatus::broken);
    CHECK(result.breakage_load >= result.first_failure_load);
    CHECK(*xfem::fracture_angle_degrees(result.breakage) < 10);
  }
}

TEST_CASE("a coarse disc breaks at first failure: its crack does not stop short of the load points") {
  for (int nodes : {60, 70, 78, 90}) {
    const common::LabTest test = test_of(LabTestKind::brazilian, nodes);
    const xfem::LabResult result = laboratory::run(test);
    INFO(nodes << " nodes");
    CHECK(result.breakage_load < 1.02 * result.first_failure_load);
  }
}

TEST_CASE("the stress at the centre of a disc under spread loads is that of its theory") {
  common::LabTest test = test_of(LabTestKind::brazilian, 5000);
  test.breakage.initiation_radius = 0;
  test.loading.largest = 1;
  for (const double patch : {0.1, 0.4}) {
    test.loading.patch = patch;
    const xfem::LabSetup setup = xfem::lab_setup(test);
    const xfem::ParticleModel model(setup.outline, 5000, {20e9, 0.2}, 0);
    const double de = common::equivalent_diameter(model.area);
    const auto forces = model.elastic.nodal_forces(setup.loads(model.elastic), patch * de);
    const auto stress = model.elastic.stresses(model.elastic.solve(forces));
    const xfem::PrincipalStress p = xfem::principal(stress[model.elastic.mesh().locate({0, 0})]);
    const double fails = xfem::HoekBrown{150e6, 25}.load_factor(p.s1, p.s3);
    INFO("patch " << patch << ": load factor at the theory's load " << fails);
    CHECK(std::abs(fails - 1) < 0.005);
  }
}

TEST_CASE("discs of every rock break within 15 % of theory at 75 nodes and 10 % from 150 on, along the load axis") {
  // Strength in MPa, m, Poisson's ratio: configs/rocks.
  const std::array<double, 3> rocks[] = {{150, 25, 0.2},   {141.1, 32, 0.22}, {148, 25, 0.32},
                                         {73.8, 17, 0.38}, {97.9, 10, 0.30},  {66.9, 9, 0.25}};
  for (const auto& [strength, m, poisson] : rocks)
    for (const int nodes : {75, 150, 300, 1200}) {
      common::LabTest test = test_of(LabTestKind::brazilian, nodes);
      test.loading.patch = 0.1;
      test.material.sigma_ci = strength * 1e6;
      test.material.m_i = m;
      test.material.poisson_ratio = poisson;
      const xfem::LabSetup setup = xfem::lab_setup(test);
      const xfem::LabResult result = xfem::run(setup, test);
      INFO("m = " << m << ", " << nodes << " nodes: " << result.breakage_load / *setup.theory_load);
      CHECK(std::abs(result.breakage_load / *setup.theory_load - 1) < (nodes < 150 ? 0.15 : 0.10));
      CHECK(result.first_failure_mode == xfem::FailureMode::tension);
      REQUIRE(xfem::fracture_angle_degrees(result.breakage));
      CHECK(*xfem::fracture_angle_degrees(result.breakage) <= 5);
    }
}

TEST_CASE("strength scales with the rock's and not with its stiffness") {
  common::LabTest test = test_of(LabTestKind::brazilian, 150);
  const double load = laboratory::run(test).first_failure_load;
  test.material.sigma_ci *= 2;
  test.material.young_modulus *= 3;
  CHECK(laboratory::run(test).first_failure_load == Approx(2 * load).epsilon(1e-12));
}

TEST_CASE("the literal reading has point loads, whatever patch is asked for") {
  common::LabTest test = test_of(LabTestKind::brazilian, 75);
  test.breakage.literal = true;
  const double point = laboratory::run(test).first_failure_load;
  test.loading.patch = 0.1;
  CHECK(laboratory::run(test).first_failure_load == point);
}

TEST_CASE("a laboratory test leaves a summary with the agreed keys, a file and a figure") {
  const scratch::Folder directory;
  const common::LabTest test = test_of(LabTestKind::brazilian, 75);
  xfem::run_lab_test(test, directory / "out");
  std::ifstream stream(directory / "out" / "summary.json");
  const auto summary = nlohmann::json::parse(stream);
  for (const char* key :
       {"schema", "test", "specimen", "mesh", "analytical", "first_failure_load", "breakage_load", "ratio",
        "failure_mode", "crack_path", "fracture_angle_deg", "fragments", "growth_steps", "status", "seconds"})
    CHECK(summary.contains(key));
  CHECK(summary["test"] == "brazilian");
  CHECK(summary["ratio"].get<double>() ==
        summary["breakage_load"].get<double>() / summary["analytical"]["breakage_load"].get<double>());
  double fragments = 0;
  for (const auto& fragment : summary["fragments"]) fragments += fragment["area"].get<double>();
  CHECK(fragments == Approx(summary["specimen"]["area"].get<double>()).epsilon(1e-12));
  CHECK(std::filesystem::file_size(directory / "out" / "result.h5") > 0);
  CHECK(std::filesystem::file_size(directory / "out" / "specimen.svg") > 0);
}

TEST_CASE("laboratory tests that make no sense are refused") {
  common::LabTest test = test_of(LabTestKind::brazilian, 75);
  test.specimen.sides = 31;
  CHECK_THROWS_WITH(xfem::brazilian_test(test), Catch::Contains("found 31, expected an even number"));
  test = test_of(LabTestKind::uniaxial, 75);
  test.loading.confining_stress = 1e6;
  CHECK_THROWS_WITH(xfem::uniaxial_test(test),
                    Catch::Contains("loading.confining_stress: found a value, expected none"));
  test = test_of(LabTestKind::bending, 75);
  test.specimen.width = 0.5;
  test.specimen.height = 0.1;
  test.specimen.span = 0.15;
  CHECK_THROWS_WITH(xfem::bending_test(test), Catch::Contains("specimen.span: found 0.15"));
  test = test_of(LabTestKind::multi_contact, 75);
  test.specimen.outline = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  test.loading.points = {{0.5, 0}, {0.5, 1}};
  test.loading.forces = {{0, 1}, {0, -0.9}};
  CHECK_THROWS_WITH(xfem::multi_contact_test(test), Catch::Contains("out of balance"));
}

TEST_CASE("a crack that the held load alone drives is refused, one that holds until the load grows is not") {
  // The held load of a confined test is equal on all sides and closes cracks: here it is a pull, which intact rock
  // bears.
  common::LabTest test = test_of(LabTestKind::tension, 300);
  test.specimen.cracks = {{common::Vec2(-0.08, 0), common::Vec2(0.08, 0)}};
  xfem::LabSetup setup = xfem::lab_setup(test);
  const double cracked = xfem::run(setup, test).first_failure_load;
  const auto pull = setup.loads;
  const auto held = [&](double share) {
    setup.held = [&pull, share](const xfem::IntactModel& model) {
      std::vector<xfem::Load> loads = pull(model);
      for (xfem::Load& load : loads) load.force *= share;
      return loads;
    };
    setup.held_load = share * setup.unit_load;
    return xfem::run(setup, test);
  };
  const double strength = cracked / setup.unit_load;
  REQUIRE(strength < 0.8);
  CHECK(held(0.95 * strength).first_failure_load == Approx(cracked).epsilon(1e-6));
  CHECK_THROWS_WITH(held(1.05 * strength), Catch::Contains("found a crack that the held load alone drives"));
}

TEST_CASE(
    "cracks that cross the specimen, miss it or meet another are refused, others leave no theory of the intact one") {
  common::LabTest test = test_of(LabTestKind::tension, 300);
  const auto outcome = [&test](std::vector<std::array<common::Vec2, 2>> cracks) {
    test.specimen.cracks = std::move(cracks);
    return xfem::run(xfem::lab_setup(test), test);
  };
  using common::Vec2;
  CHECK_THROWS_WITH(outcome({{Vec2(1, 0), Vec2(1, 1)}}), Catch::Contains("expected at least one inside"));
  CHECK_THROWS_WITH(outcome({{Vec2(-1, 0), Vec2(1, 0)}}), Catch::Contains("expected at least one inside"));
  CHECK_THROWS_WITH(outcome({{Vec2(-0.1, 0), Vec2(0.1, 0)}, {Vec2(-0.1, 0), Vec2(0.1, 0)}}),
                    Catch::Contains("found cracks 0 and 1"));
  const xfem::LabSetup setup = xfem::lab_setup(test);
  CHECK_FALSE(setup.theory_load.has_value());
  CHECK(setup.estimate.has_value());
}
