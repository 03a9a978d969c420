// A single-specimen laboratory test. Plain structs with defaults (SI units).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scene.hpp"

namespace common {

enum class LabTestKind { brazilian, uniaxial, confined, tension, bending, point_load, multi_contact };

/// The name of a kind, as in the key `test`.
const char* name_of(LabTestKind kind);

struct SpecimenOptions {
  double diameter = 0.5;       ///< disc (brazilian); longest distance between two vertices of a particle [m]
  int sides = 64;              ///< of the polygon that stands for the disc
  double width = 0.25;         ///< block tests; length of a beam [m]
  double height = 0.5;         ///< block tests; depth of a beam [m]
  std::optional<double> span;  ///< distance of a beam's supports [m]; auto: 0.8 width
  Polygon outline;             ///< of a particle, any scale; empty: generated
  int corners = 7;             ///< of a generated particle
  double roughness = 0.4;      ///< scatter of its corner angles, in spacings
  double aspect = 0.8;         ///< ratio of its width to its length
  std::vector<std::array<Vec2, 2>> cracks;  ///< straight, from end to end [m]; load axis y, centroid the origin
};

struct LabLoading {
  double confining_stress = 0;  ///< [Pa]
  double platen_friction = 0;   ///< [-]
  double patch = 0;             ///< width over which a point load is spread, in De; 0: point load
  double direction = 0;         ///< point_load: angle of the load axis against y in the outline's frame [deg]
  int contacts = 5;             ///< multi_contact: number of random forces
  double friction = 0.5;        ///< multi_contact: largest ratio of shear to normal of a random force
  Polygon points;               ///< multi_contact: given points in the outline's frame [m]; empty: random
  std::vector<Vec2> forces;     ///< and the forces there, any scale
  double step = 0.01;           ///< growth of the load from one analysis to the next, after first failure
  double largest = 20;          ///< the test ends unbroken at this multiple of the load at first failure
};

struct LabTest {
  std::filesystem::path file;
  LabTestKind test = LabTestKind::brazilian;
  std::uint64_t seed = 1;  ///< of a generated particle and of random forces
  Effects effects;         ///< toughness, face_friction
  MaterialOptions material;
  SpecimenOptions specimen;
  int mesh_nodes = 150;     ///< key mesh.nodes
  double mesh_grading = 1;  ///< key mesh.grading
  LabLoading loading;
  BreakageOptions breakage;  ///< `nodes` and `interval` are not used here
  /// Values of keys over which pipeline/lab runs the test, as [key, values]; here only validated.
  std::vector<std::string> sweep;  ///< names of the keys
};

/// As read_scene. A block or a particle may be any size; what a kind does not use is checked by the kind itself.
LabTest read_lab_test(const std::filesystem::path& file, const Overrides& overrides = {});
/// The resolved test without its sweep.
std::string to_yaml(const LabTest& test);
/// Hex XXH3-128 over the resolved keys that xfem uses: of a rock its numbers count, not its name or its file.
std::string config_hash(const LabTest& test);
std::vector<Key> lab_test_keys();

}  // namespace common
