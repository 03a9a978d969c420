#include "xfem/lab/laboratory.hpp"

#include <fmt/format.h>

#include <chrono>
#include <limits>

#include "common/error.hpp"
#include "xfem/lab/report.hpp"
#include "xfem/solve_frame.hpp"

namespace xfem {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// First failure is met from just above, so that rounding does not decide whether the crack starts.
constexpr double kJustAbove = 1e-9;

LabSetup setup_of(const common::LabTest& test) {
  switch (test.test) {
    case common::LabTestKind::brazilian:
      return brazilian_test(test);
    case common::LabTestKind::uniaxial:
      return uniaxial_test(test);
    default:
      throw common::bad_input("test: this kind cannot be run; expected one of brazilian, uniaxial");
  }
}

}  // namespace

LabResult run(const LabSetup& setup, const common::LabTest& test) {
  const auto start = std::chrono::steady_clock::now();
  BreakageParameters parameters = breakage_parameters(test.material, test.breakage);
  parameters.load_patch = parameters.literal ? 0 : setup.load_patch;
  const ParticleModel model(setup.outline, test.mesh_nodes, elastic_constants(test.material),
                            parameters.initiation_radius);
  const std::vector<Load> loads = setup.loads(model.elastic.mesh());

  LabResult result;
  result.rock = parameters.rock;
  result.mesh = model.elastic.mesh();
  const double patch = parameters.load_patch * common::equivalent_diameter(model.area);
  const std::vector<Stress> unit =
      model.elastic.stresses(model.elastic.solve(model.elastic.nodal_forces(loads, patch)));
  const std::vector<Stress> averaged = model.average(unit);
  double smallest = kInfinity;
  int critical = -1;
  for (std::size_t e = 0; e < averaged.size(); ++e) {
    const PrincipalStress p = principal(averaged[e]);
    const double factor = parameters.rock.load_factor(p.s1, p.s3);
    if (factor < smallest) {
      smallest = factor;
      critical = static_cast<int>(e);
    }
  }
  result.first_failure_load = smallest * setup.unit_load;
  result.breakage_load = kInfinity;
  const double shown = critical < 0 ? 1 : smallest;
  const auto at_first_failure = [shown](const std::vector<Stress>& stresses) {
    std::vector<Stress> scaled;
    for (const Stress& s : stresses) scaled.push_back({shown * s.xx, shown * s.yy, shown * s.xy});
    return scaled;
  };
  result.element_stress = at_first_failure(unit);
  result.averaged_stress = at_first_failure(averaged);
  if (critical >= 0) {
    result.first_failure_point = result.mesh.centroid(critical);
    std::vector<Crack> cracks;
    const double first = smallest * (1 + kJustAbove);
    for (double factor = first; factor <= kLargestLoadRatio * first; factor *= 1 + kLoadStep) {
      parameters.load_factor = factor;
      result.breakage = analyse(model, loads, cracks, parameters);
      result.growth_steps += result.breakage.growth_steps;
      if (result.breakage.status == common::ParticleStatus::broken) result.breakage_load = factor * setup.unit_load;
      if (result.breakage.status == common::ParticleStatus::broken ||
          result.breakage.status == common::ParticleStatus::refused)
        break;
      cracks = result.breakage.cracks;
    }
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::string run_lab_test(const common::LabTest& test, const std::filesystem::path& directory) {
  const LabSetup setup = setup_of(test);
  const LabResult result = run(setup, test);
  std::error_code failed;
  std::filesystem::create_directories(directory, failed);
  if (failed) throw common::io_failure(fmt::format("{}: {}", directory.string(), failed.message()));
  write_lab_summary(directory / "summary.json", setup, result, test);
  write_lab_result(directory / "result.h5", setup, result);
  write_lab_figure(directory / "specimen.svg", setup, result);
  return fmt::format("{}: first failure at {:.4f} of theory, breakage at {:.4f}; {}", setup.test,
                     result.first_failure_load / setup.theory_load, result.breakage_load / setup.theory_load,
                     (directory / "summary.json").string());
}

}  // namespace xfem
