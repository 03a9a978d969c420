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

TEST_CASE("A laboratory test that cannot be run or read is refused with its place") {
  CHECK(error_of("mesh: {nodes: 100}\ntest: bending\n") ==
        "t.yaml:2:7: test: found a kind that cannot be run, expected one that this version runs: brazilian, uniaxial");
  CHECK(error_of("mesh: {nodes: 100}\n") ==
        "t.yaml:1:1: test: found nothing, expected the kind of test; this version runs brazilian and uniaxial");
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
  CHECK(tests >= 2);
}
