// One particle's life under one set of contact forces: loads -> stress -> criterion -> growth -> split.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/scene.hpp"
#include "xfem/crack/path.hpp"
#include "xfem/elasticity/intact_model.hpp"

namespace xfem {

struct BreakageParameters {
  HoekBrown rock{150e6, 25};
  double initiation_radius = 0.1;  ///< in De = sqrt(4 A / pi); 0: element stress
  double load_patch = 0;           ///< in De; 0: point loads
  double minimum_fragment = 0.03;  ///< fraction of the parent's area
  double minimum_area = 0.02;      ///< [m^2]
  int max_cracks = 3;
  bool literal = false;      ///< the paper's own reading
  double face_friction = 0;  ///< Coulomb coefficient of closed crack faces; 0: smooth
  double toughness = 0;      ///< K_Ic [Pa sqrt(m)]; 0: none declared, cracks grow by strength alone
  /// A laboratory test grows the crack at the load at which it starts (lambda >= 1 allowed), so that the loads given
  /// here are multiplied by this factor before anything else.
  double load_factor = 1;
};

/// The same with lengths in another unit [m].
BreakageParameters in_units_of(double length, BreakageParameters parameters);

/// What does not change while the particle is intact; made once, shared by all its analyses.
/// Any unit of length will do, as long as loads, cracks and parameters are in the same.
struct ParticleModel {
  ParticleModel(PolygonView outline, int nodes, const ElasticConstants& constants, double averaging_radius_in_de);
  /// On a mesh of the caller's.
  ParticleModel(PolygonView outline, Mesh mesh, const ElasticConstants& constants, double averaging_radius_in_de);
  /// In canonical coordinates: loads as force / De, stresses come out in Pa.
  ParticleModel(const CanonicalOutline& shape, int nodes, const ElasticConstants& constants,
                double averaging_radius_in_de);
  Polygon outline;
  double area;
  IntactModel elastic;
  StressAverage average;
};

struct BreakageResult {
  common::ParticleStatus status = common::ParticleStatus::intact;
  std::string reason;            ///< of a refusal or an arrest, else empty
  Stress mean_stress;            ///< area average over the elements, body frame, compression positive
  double min_safety_factor = 0;  ///< smallest load factor of the uncracked averaged field, +inf if unloaded
  FailureMode failure_mode = FailureMode::none;
  std::vector<Crack> cracks;                ///< all cracks after the analysis (also of a broken particle)
  std::optional<std::array<Vec2, 2>> path;  ///< breakage line, body frame, if broken
  std::vector<int> path_cracks;             ///< indices of the cracks that hang together with the path, ascending
  Polygon left, right;                      ///< fragments in the parent's body frame, if broken
  int growth_steps = 0;
  double unbalance = 0;  ///< IntactModel::unbalance of the loads
};

/// Analyses one particle: re-enters its stored cracks, tests initiation and growth, one element per step and tip, and
/// splits it if a path crosses it. Every loop is bounded; it never throws for a mechanical reason: what it cannot do
/// comes out as `refused` with the reason. A pure function of its arguments.
BreakageResult analyse(const ParticleModel& model, std::span<const Load> loads, std::span<const Crack> cracks,
                       const BreakageParameters& parameters);

/// The load factor, of these loads, at which the first tip of the given cracks advances; infinite if none ever does. It
/// is exact: contact of the crack faces does not change the proportion of stress and load. `load_factor` is not used.
double first_growth(const ParticleModel& model, std::span<const Load> loads, std::span<const Crack> cracks,
                    const BreakageParameters& parameters);

}  // namespace xfem
