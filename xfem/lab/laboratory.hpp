// Single-specimen laboratory tests under load control: what each test is, and the runner that they share.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/lab_test.hpp"
#include "xfem/breakage.hpp"

namespace xfem {

/// A laboratory test ready to run: y is the load axis, the specimen's centroid the origin.
struct LabSetup {
  std::string test;  ///< its name
  Polygon outline;   ///< [m]
  /// Forces at load factor 1 on a mesh of the outline; together they carry `unit_load`.
  std::function<std::vector<Load>(const Mesh&)> loads;
  double unit_load = 0;    ///< [N] per metre of thickness
  double load_patch = 0;   ///< width of a point load, in De
  double theory_load = 0;  ///< first failure and breakage by theory [N/m]
  /// More that theory says, as name and value, for `analytical` in summary.json.
  std::vector<std::pair<std::string, double>> theory;
};

/// Indirect tension of a disc, see lab/brazilian.cpp.
LabSetup brazilian_test(const common::LabTest& test);
/// Compression of a block between smooth platens, see lab/uniaxial.cpp.
LabSetup uniaxial_test(const common::LabTest& test);

/// Load is raised by this fraction at a time after first failure; the resolution of the breakage load.
inline constexpr double kLoadStep = 0.01;
/// The test ends, unbroken, at this multiple of the load at first failure.
inline constexpr double kLargestLoadRatio = 20;

struct LabResult {
  HoekBrown rock{0, 0};
  Mesh mesh;
  std::vector<Stress> element_stress;   ///< at first failure [Pa]
  std::vector<Stress> averaged_stress;  ///< what the criterion saw there [Pa]
  double first_failure_load = 0;        ///< [N/m]; +inf if the specimen cannot fail
  double breakage_load = 0;             ///< [N/m]; +inf if it did not break
  Vec2 first_failure_point{0, 0};       ///< centroid of the critical element
  BreakageResult breakage;              ///< the last analysis: of the breakage load, or of the largest
  int growth_steps = 0;                 ///< over all load steps
  double seconds = 0;
};

/// First failure by linearity: unit_load times the smallest load factor of the intact field. Then the load rises from
/// there in steps of kLoadStep; at each level the cracks so far, which never heal, are analysed anew.
LabResult run(const LabSetup& setup, const common::LabTest& test);

/// Runs a test and writes DIR/summary.json, DIR/result.h5 and DIR/specimen.svg; returns a line for people.
/// Throws bad_input for a test that cannot be run, io_failure.
std::string run_lab_test(const common::LabTest& test, const std::filesystem::path& directory);

}  // namespace xfem
