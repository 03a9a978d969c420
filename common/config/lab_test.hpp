// A single-specimen laboratory test. Plain structs with defaults (SI units).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/scene.hpp"

namespace common {

enum class LabTestKind { brazilian, uniaxial, confined, tension, bending, point_load, multi_contact };

struct SpecimenOptions {
  double diameter = 0.5;  ///< disc (brazilian) [m]
  int sides = 64;         ///< of the polygon that stands for the disc
  double width = 0.25;    ///< block tests [m]
  double height = 0.5;    ///< [m]
};

struct LabLoading {
  double confining_stress = 0;  ///< [Pa]
  double platen_friction = 0;   ///< [-]
  double patch = 0;             ///< width over which a point load is spread, in De; 0: point load
};

struct LabTest {
  std::filesystem::path file;
  LabTestKind test = LabTestKind::brazilian;
  MaterialOptions material;
  SpecimenOptions specimen;
  int mesh_nodes = 150;  ///< key mesh.nodes
  LabLoading loading;
  BreakageOptions breakage;  ///< `nodes` and `interval` are not used here
};

/// As read_scene. Kinds that this version cannot run are refused with a message that lists those it can.
LabTest read_lab_test(const std::filesystem::path& file, const Overrides& overrides = {});
std::string to_yaml(const LabTest& test);
std::vector<Key> lab_test_keys();

}  // namespace common
