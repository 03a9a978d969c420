#include "common/config/lab_test.hpp"

#include "common/config/document.hpp"
#include "common/config/sections.hpp"
#include "common/error.hpp"

namespace common {
namespace {

Specification specification(LabTest& test) {
  Specification keys;
  keys.choice("test", test.test,
              {"brazilian", "uniaxial", "confined", "tension", "bending", "point_load", "multi_contact"}, UsedBy::xfem,
              "kind of test");
  bind_material(keys, test.material, false);
  keys.number("specimen.diameter", test.specimen.diameter, kPositive, "m", UsedBy::xfem, "brazilian: disc diameter");
  keys.integer("specimen.sides", test.specimen.sides, 8, 10'000, "-", UsedBy::xfem,
               "brazilian: sides of the polygon that stands for the disc");
  keys.number("specimen.width", test.specimen.width, kPositive, "m", UsedBy::xfem, "uniaxial: width of the block");
  keys.number("specimen.height", test.specimen.height, kPositive, "m", UsedBy::xfem, "uniaxial: height of the block");
  bind_mesh_nodes(keys, "mesh.nodes", test.mesh_nodes);
  keys.number("loading.confining_stress", test.loading.confining_stress, kNonNegative, "Pa", UsedBy::xfem,
              "lateral stress on a block; 0: uniaxial");
  keys.number("loading.platen_friction", test.loading.platen_friction, kNonNegative, "-", UsedBy::xfem,
              "uniaxial: Coulomb coefficient of the platens; 0: smooth");
  keys.number("loading.patch", test.loading.patch, {0, 1}, "De", UsedBy::xfem,
              "brazilian: width over which a point load is spread, in De = sqrt(4 A / pi); 0: point load");
  bind_particle_breakage(keys, test.breakage);
  return keys;
}

}  // namespace

LabTest read_lab_test(const std::filesystem::path& file, const Overrides& overrides) {
  LabTest test;
  test.file = file;
  Specification keys = specification(test);
  keys.read(load_document(file));
  for (const std::string& assignment : overrides) keys.set(assignment);
  keys.finish();
  if (!keys.given("test")) {
    keys.fail({}, "test: found nothing, expected the kind of test; this version runs brazilian and uniaxial");
  } else if (test.test != LabTestKind::brazilian && test.test != LabTestKind::uniaxial) {
    keys.fail({"test"},
              "test: found a kind that cannot be run, expected one that this version runs: brazilian, uniaxial");
  }
  keys.finish();
  return test;
}

std::string to_yaml(const LabTest& test) {
  LabTest copy = test;
  return specification(copy).to_yaml("# The resolved laboratory test: every key with its value, [unit] and meaning.\n");
}

std::vector<Key> lab_test_keys() {
  LabTest test;
  return specification(test).keys();
}

}  // namespace common
