// Single-specimen laboratory tests under load control: what each test is, and the runner that they share.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/lab_test.hpp"
#include "xfem/breakage.hpp"

namespace xfem {

using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// A laboratory test ready to run: y is the load axis, the specimen's centroid the origin. The load is
/// held_load + factor * unit_load, and only the factor grows.
struct LabSetup {
  using Loads = std::function<std::vector<Load>(const IntactModel&)>;

  std::string test;         ///< its name
  Polygon outline;          ///< [m]
  Loads loads;              ///< forces at factor 1; together they carry `unit_load`
  Loads held;               ///< forces that do not grow, as a confining stress; empty: none
  double unit_load = 0;     ///< [N] per metre of thickness
  double held_load = 0;     ///< [N/m]
  double load_patch = 0;    ///< width of a point load, in De
  NamedNumbers dimensions;  ///< of the specimen, for summary.json

  std::optional<double> theory_load;  ///< first failure and breakage by theory [N/m]; absent: there is none
  NamedNumbers theory;                ///< more that theory says, for `analytical` in summary.json
  std::optional<double> estimate;     ///< where there is no theory: a load of the right size [N/m]
  std::string estimate_source;
};

/// The setup of a test, see the file of its kind. Throws bad_input for what the kind does not take.
LabSetup lab_setup(const common::LabTest& test);

/// CPU time of the calling thread [s], which a busy machine disturbs less than a clock on the wall.
struct LabCpuSeconds {
  double set_up = 0;    ///< mesh, factor and averages of the specimen, once in its life
  double analyses = 0;  ///< of all load levels
};

struct LabResult {
  HoekBrown rock{0, 0};
  Mesh mesh;
  std::vector<Load> loads;              ///< at first failure [N/m]
  std::vector<Stress> element_stress;   ///< of the specimen without cracks, at first failure [Pa]
  std::vector<Stress> averaged_stress;  ///< what the criterion saw there [Pa]
  double first_failure_load = 0;        ///< [N/m]; +inf if the specimen cannot fail
  double breakage_load = 0;             ///< [N/m]; +inf if it did not break
  Vec2 first_failure_point{0, 0};       ///< centroid of the critical element of that field
  FailureMode first_failure_mode = FailureMode::none;
  BreakageResult breakage;  ///< the last analysis: of the breakage load, or of the largest
  int growth_steps = 0;     ///< over all load steps
  int load_levels = 0;      ///< analyses made
  LabCpuSeconds cpu_seconds;
  double seconds = 0;  ///< on the wall
};

/// First failure of the intact field (see first_failure.hpp). Then the factor rises from there in steps of
/// loading.step; at each level the cracks so far, which never heal, are analysed anew.
LabResult run(const LabSetup& setup, const common::LabTest& test);

/// Runs a test and writes summary.json, result.h5, specimen.svg and case.yaml (the resolved test); returns a line for
/// people. Its times are medians over `repeats` runs (>= 1). Throws bad_input for a test that cannot be run,
/// io_failure.
std::string run_lab_test(const common::LabTest& test, const std::filesystem::path& directory, int repeats = 1);

}  // namespace xfem
