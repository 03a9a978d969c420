#include "common/config/lab_test.hpp"

#include <catch2/catch.hpp>

#include "scratch.hpp"

using namespace common;

namespace {

std::string error_of(const std::string& text, const Overrides& overrides = {}) {
  const scratch::Folder folder;
  const auto file = folder.write("t.yaml", text);
  return scratch::message_of(folder, [&] { read_lab_test(file, overrides); });
}

}  // namespace

TEST_CASE("A laboratory test is read with its defaults and overrides") {
  const scratch::Folder folder;
  const auto file = folder.write("t.yaml", R"(
test: uniaxial
material: {sigma_ci: 1e8}
specimen: {width: 0.2}
mesh: {nodes: 300}
loading: {platen_friction: 0.1}
breakage: {literal: true}
)");
  const LabTest test = read_lab_test(file, {"specimen.height=0.4", "mesh.nodes=75"});
  CHECK(test.file == file);
  CHECK(test.test == LabTestKind::uniaxial);
  CHECK(test.material.sigma_ci == 1e8);
  CHECK(test.material.m_i == MaterialOptions{}.m_i);
  CHECK(test.specimen.width == 0.2);
  CHECK(test.specimen.height == 0.4);
  CHECK(test.specimen.diameter == SpecimenOptions{}.diameter);
  CHECK(test.mesh_nodes == 75);
  CHECK(test.loading.platen_friction == 0.1);
  CHECK(test.breakage.literal);
  const LabTest again = read_lab_test(folder.write("r.yaml", to_yaml(test)));
  CHECK(to_yaml(again) == to_yaml(test));
}

TEST_CASE("A laboratory test takes cracks and the effects that act on one particle") {
  const scratch::Folder folder;
  const LabTest test = read_lab_test(folder.write("t.yaml", R"(
test: brazilian
effects: [toughness, face_friction]
material: {fracture_toughness: 2e6}
specimen: {cracks: [[0, -0.05, 0, 0.05], [0.1, 0, 0.2, 0.1]]}
breakage: {face_friction: 0.4}
)"));
  CHECK(test.effects.toughness);
  CHECK(test.effects.face_friction);
  CHECK(test.material.fracture_toughness == 2e6);
  CHECK(test.breakage.face_friction == 0.4);
  REQUIRE(test.specimen.cracks.size() == 2);
  CHECK(test.specimen.cracks[1][1] == Vec2(0.2, 0.1));
  const LabTest again = read_lab_test(folder.write("r.yaml", to_yaml(test)));
  CHECK(to_yaml(again) == to_yaml(test));
  CHECK_THAT(error_of("test: brazilian\neffects: [gravity]\n"), Catch::Contains("expected a list of toughness"));
  CHECK_THAT(error_of("test: brazilian\nspecimen: {cracks: [[0, 1, 2]]}\n"), Catch::Contains("[x1, y1, x2, y2]"));
  CHECK_THAT(error_of("test: brazilian\nspecimen: {cracks: [[0, 1, 0, 1]]}\n"), Catch::Contains("two ends apart"));
  CHECK_THAT(error_of("test: brazilian\neffects: [toughness]\nbreakage: {literal: true}\n"),
             Catch::Contains("breakage.literal"));
}

TEST_CASE("A laboratory test that cannot be run or read is refused with its place") {
  CHECK(error_of("mesh: {nodes: 100}\n") ==
        "t.yaml:1:1: test: found nothing, expected the kind of test, one of brazilian, uniaxial, confined, tension, "
        "bending, point_load, multi_contact");
  CHECK(error_of("test: multi_contact\nloading: {points: [[0, 0], [1, 1]]}\n") ==
        "t.yaml:2:19: loading: found 2 points and 0 forces, expected a force for each point");
  CHECK(error_of("test: multi_contact\nloading: {forces: [[0, 0, 1]]}\n").find("expected a pair [x, y]") !=
        std::string::npos);
  CHECK(error_of("test: point_load\nspecimen: {outline: [[0, 0], [1, 0]]}\n").find("t.yaml:2:21: specimen.outline: ") ==
        0);
  CHECK(error_of("test: brazilian\nsweep: {mesh.node: [75, 150]}\n") ==
        "t.yaml:2:8: sweep: found \"mesh.node\", expected a key of a laboratory test");
  CHECK(error_of("test: brazilian\nsweep: {mesh.nodes: 75}\n") ==
        "t.yaml:2:21: sweep.mesh.nodes: found 75, expected a list of values, or labels with the keys of each");
  CHECK(error_of("test: brasilian\n")
            .find("t.yaml:1:7: test: found \"brasilian\", expected one of brazilian, uniaxial, ") == 0);
  CHECK(error_of("test: brazilian\nmesh: {node: 100}\n") ==
        "t.yaml:2:8: unknown key \"node\" in mesh; did you mean \"nodes\"?");
  CHECK(error_of("test: brazilian\nspecimen: {sides: 3}\n") ==
        "t.yaml:2:19: specimen.sides: found 3, expected an integer in [8, 10000]");
  CHECK(error_of("test: brazilian\n", {"loading.patch=2"}) ==
        "--set loading.patch=2: loading.patch: found 2, expected a number in [0, 1] [De]");
  CHECK(error_of("test: brazilian\nbreakage: {interval: 0.001}\n")
            .find("t.yaml:2:12: unknown key \"interval\" in breakage; expected one of initiation_radius, ") == 0);
  CHECK(error_of("test: brazilian\ntest: uniaxial\n") ==
        "t.yaml:2:1: duplicate key \"test\", first given at t.yaml:1:1; expected each key once");
}

TEST_CASE("Every laboratory test in configs is valid") {
  int tests = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(ROCKBREAK_SOURCE_DIR) / "configs/lab")) {
    if (entry.path().extension() != ".yaml") continue;
    INFO(entry.path());
    CHECK_NOTHROW(read_lab_test(entry.path()));
    ++tests;
  }
  CHECK(tests >= 10);
}

TEST_CASE("A rock's file gives the keys that the test does not give itself") {
  const scratch::Folder folder;
  folder.write("rocks/soft.yaml", "name: soft\nsource: made up\nsigma_ci: 50e6\nm_i: 7\nyoung_modulus: 5e9\n");
  folder.write("rocks/hard.yaml", "name: hard\nsigma_ci: 250e6\nm_i: 32\n");
  const auto file = folder.write("lab/t.yaml", "test: uniaxial\nmaterial: {m_i: 8, rock: ../rocks/soft.yaml}\n");
  const LabTest test = read_lab_test(file);
  CHECK(test.material.name == "soft");
  CHECK(test.material.source == "made up");
  CHECK(test.material.sigma_ci == 50e6);
  CHECK(test.material.m_i == 8);
  CHECK(test.material.young_modulus == 5e9);
  CHECK(test.material.poisson_ratio == MaterialOptions{}.poisson_ratio);

  SECTION("on the command line another rock replaces what it gives, and other keys go before it in any order") {
    const std::string hard = "material.rock=" + (file.parent_path() / "../rocks/hard.yaml").string();
    const LabTest other = read_lab_test(file, {"material.sigma_ci=99e6", hard});
    CHECK(other.material.name == "hard");
    CHECK(other.material.m_i == 32);
    CHECK(other.material.sigma_ci == 99e6);
    CHECK(other.material.young_modulus == 5e9);
  }
  SECTION("the hash covers its numbers, not its name, file or source, and the resolved test needs the file no more") {
    const auto same =
        folder.write("s.yaml", "test: uniaxial\nmaterial: {sigma_ci: 50e6, m_i: 8, young_modulus: 5e9}\n");
    CHECK(config_hash(read_lab_test(same)) == config_hash(test));
    CHECK(config_hash(read_lab_test(same, {"material.m_i=9"})) != config_hash(test));
    const LabTest again = read_lab_test(folder.write("elsewhere/r.yaml", to_yaml(test)));
    CHECK(to_yaml(again) == to_yaml(test));
    CHECK(config_hash(again) == config_hash(test));
  }
  SECTION("a file that is missing or wrong is refused with its place") {
    const auto error = [&](const std::string& name) {
      const auto wrong = folder.write("t.yaml", "test: uniaxial\nmaterial: {rock: " + name + "}\n");
      return scratch::message_of(folder, [&] { read_lab_test(wrong); });
    };
    CHECK(error("rocks/none.yaml") == "t.yaml:2:18: material.rock: rocks/none.yaml: the file does not exist");
    folder.write("rocks/bad.yaml", "sigma_c: 50e6\n");
    CHECK(error("rocks/bad.yaml").find("rocks/bad.yaml:1:1: unknown key \"sigma_c\" in material; did you mean ") == 0);
    folder.write("rocks/loop.yaml", "rock: loop.yaml\n");
    CHECK(error("rocks/loop.yaml").find("this file is named by another one") != std::string::npos);
  }
}

TEST_CASE("Every rock in configs is a rock") {
  const scratch::Folder folder;
  const auto file = folder.write("t.yaml", "test: uniaxial\n");
  int rocks = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(ROCKBREAK_SOURCE_DIR) / "configs/rocks")) {
    INFO(entry.path());
    const LabTest test = read_lab_test(file, {"material.rock=" + entry.path().string()});
    CHECK_FALSE(test.material.name.empty());
    CHECK_FALSE(test.material.source.empty());
    CHECK(test.material.sigma_ci / test.material.m_i > 1e6);
    ++rocks;
  }
  CHECK(rocks >= 6);
}
