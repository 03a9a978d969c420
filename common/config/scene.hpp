// A scene: what a run simulates. Plain structs with defaults (SI units); `scene_specification` documents every key.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/config/grading.hpp"
#include "common/config/specification.hpp"
#include "common/geometry/polygon.hpp"
#include "common/io/immutable_file.hpp"

namespace common {

/// What is not named in `effects` does not exist in the run.
struct Effects {
  bool friction = false;
  bool local_damping = false;
  bool energy_ledger = false;
  bool breakage = false;
  bool contact_damping = false;
  bool rolling_resistance = false;
  bool gravity = false;
  bool mass_scaling = false;
  bool toughness = false;
  bool face_friction = false;
};

struct MaterialOptions {
  std::string name;                 ///< of the rock; empty: none given
  std::string source;               ///< of its numbers
  double density = 2500;            ///< [kg/m^3]
  double sigma_ci = 150e6;          ///< uniaxial compressive strength [Pa]
  double m_i = 25;                  ///< Hoek-Brown [-]
  double young_modulus = 20e9;      ///< [Pa]
  double poisson_ratio = 0.2;       ///< [-]
  bool plane_stress = false;        ///< plane strain otherwise
  double fracture_toughness = 1e6;  ///< K_Ic [Pa sqrt(m)], with effect toughness
};

/// Shape types: a list of outlines, or drawn from the seeded generator.
struct ShapeOptions {
  std::string source = "generated";  ///< generated | outlines (read_scene turns `file` into outlines)
  int types = 12;                    ///< number of generated shape types
  int corners_min = 5, corners_max = 8;
  double roughness = 0.4;         ///< scatter of corner angles, in spacings, [0, 0.45]; 0: evenly spaced
  double aspect = 0.7;            ///< smallest ratio of width to length drawn, (0, 1]
  std::vector<Polygon> outlines;  ///< source outlines: each at least 3 points, any scale
  std::string file;  ///< where the outlines were read: CSV (type,x,y) or YAML; absolute; empty: from nowhere
};

struct AssemblyOptions {
  int particles = 1194;
  double diameter_min = 0.37;  ///< longest distance between two vertices [m]; with a grading its ends
  double diameter_max = 0.57;
  Grading grading;           ///< empty: diameters uniform, by number, between the two (read_scene reads the file)
  std::string grading_file;  ///< where the grading was read; absolute; empty: from nowhere
  ShapeOptions shapes;

  /// Mean of the two diameters [m]; with a grading, diameter of the mean area.
  double mean_diameter() const;
};

enum class ContactLaw { mean_depth, area, potential, foundation };

/// True if the law's normal stiffness is in N/m^2, false if in N/m.
inline bool stiffness_is_per_area(ContactLaw law) {
  return law == ContactLaw::area || law == ContactLaw::foundation;
}

struct ContactOptions {
  ContactLaw law = ContactLaw::foundation;
  double normal_stiffness = 5e9;               ///< N/m for mean_depth and potential, N/m^2 for area and foundation
  std::optional<double> tangential_stiffness;  ///< [N/m]; absent (auto): see contact/laws
  double friction = 0.5;                       ///< Coulomb coefficient in shear [-]
  double rolling_friction = 0.1;               ///< rolling moment / (normal force * rolling radius), largest [-]
};

struct DampingOptions {
  double local = 0.5;    ///< Cundall local damping coefficient [-]
  double contact = 0.2;  ///< viscous damping of a contact, share of critical [-]
};

struct GravityOptions {
  Vec2 acceleration = Vec2(0, -9.81);  ///< [m/s^2]
};

struct MassScalingOptions {
  double smallest_mass = 0.05;  ///< lighter particles move as if they had this share of the mean original mass [-]
};

struct TimeStepOptions {
  double safety = 0.25;  ///< dt = safety * sqrt(m_min / k_max)
};

struct NeighbourOptions {
  double skin = 0.06;  ///< how far outlines may approach each other before pairs are searched again [diameter_min]
};

enum class VoidRatioDefinition { e1, e2, e4 };

struct PreparationOptions {
  double confining_pressure = 2e6;  ///< [Pa]
  double void_ratio = 0.30;         ///< target before shear [-]
  VoidRatioDefinition definition = VoidRatioDefinition::e4;
  double void_ratio_tolerance = 0.002;
  double compaction_rate = 0.3;    ///< affine compaction [1/s]
  double initial_friction = 1.0;   ///< during confinement, before it is lowered [-]
  double unbalanced_force = 1e-3;  ///< at rest: mean |sum F| over mean normal force [-]
  std::string from;                ///< start from this prepared frame (absolute once read); empty: prepare
};

struct ServoOptions {
  double modulus = 1e8;  ///< K [Pa]: assembly stiffness that the gains refer to
  double max_rate = 0;   ///< largest lateral strain rate [1/s]; 0 (auto)
};

struct ShearOptions {
  double axial_strain = 0.173;
  double strain_rate = 0.02;             ///< [1/s]
  double ramp_strain = 0.001;            ///< axial strain over which the rate grows from zero
  std::optional<double> frame_interval;  ///< axial strain between frames without breakage; auto: 0.005
  int history_interval = 100;            ///< steps between two history rows
};

struct BreakageOptions {
  double interval = 0.0005;        ///< axial strain between two analyses
  int nodes = 150;                 ///< mesh nodes of a particle
  double initiation_radius = 0.1;  ///< stress averaging radius at initiation, in De
  double minimum_fragment = 0.03;  ///< fraction of the parent's area
  double minimum_area = 0.02;      ///< [m^2]
  int max_cracks = 3;              ///< per particle
  double face_friction = 0.6;      ///< Coulomb coefficient of closed crack faces, with effect face_friction [-]
  bool literal = false;            ///< the paper's own reading: point loads, radius 0, adjacent element
};

struct OutputOptions {
  Durability durability;  ///< none | every | N
  int keep_frames = 0;    ///< 0: all; a run takes nothing else
};

/// What a breakage analysis that was refused for a particle means to the run.
enum class Refusals { stop, go_on };

/// Limits beyond which a run stops with exit code 3 (dem/guards.hpp). They change no number of a run, so no
/// configuration hash covers them.
struct GuardOptions {
  double unbalanced_force = 0.03;  ///< mean |sum F| / mean normal force, smallest between two frames
  double energy_residual = 0.05;   ///< of boundary work and stored energy
  double servo_error = 0.3;        ///< |lateral stress / pressure - 1|, smallest between two frames
  double overlap = 0.5;            ///< of two particles, in areas of the smaller one
  double steps = 1e9;              ///< that a run still takes at its present time step
  Refusals refusals = Refusals::stop;

  bool operator==(const GuardOptions&) const = default;
};

struct Scene {
  std::filesystem::path file;  ///< where it was read; empty if made in code
  std::uint64_t seed = 1;
  Effects effects;
  MaterialOptions material;
  AssemblyOptions assembly;
  ContactOptions contact;
  DampingOptions damping;
  GravityOptions gravity;
  MassScalingOptions mass_scaling;
  TimeStepOptions time_step;
  NeighbourOptions neighbours;
  PreparationOptions preparation;
  ServoOptions servo;
  ShearOptions shear;
  BreakageOptions breakage;
  GuardOptions guards;
  OutputOptions output;

  /// Axial strain between two frames.
  double frame_interval() const { return effects.breakage ? breakage.interval : shear.frame_interval.value_or(0.005); }
};

/// Reads, validates and completes a scene. Throws bad_input with `FILE:LINE:COLUMN: ...` for an unknown key (with the
/// nearest valid name), wrong type, number out of range, duplicate key, NaN or infinity, syntax error; io_failure
/// never: a file that is not there is bad_input naming it.
Scene read_scene(const std::filesystem::path& file, const Overrides& overrides = {});

/// The resolved scene as YAML that PyYAML reads with the same types (floats as 150.0e+6), every default written out
/// and every key commented with its unit and description.
std::string to_yaml(const Scene& scene);

/// Hex XXH3-128 over the resolved keys that the executable (dem or xfem) uses; never `guards`, `output`, threads or
/// file names: of files of outlines and gradings the content counts, and the frame named by `preparation.from` records
/// its own configuration.
std::string config_hash(const Scene& scene, UsedBy executable);

/// Every key of a scene, in order, for `explain` and the documentation.
std::vector<Key> scene_keys();

}  // namespace common
