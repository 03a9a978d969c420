#include "xfem/lab/laboratory.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "xfem/crack/given_crack.hpp"
#include "xfem/crack/growth.hpp"
#include "xfem/lab/first_failure.hpp"
#include "xfem/lab/kinds.hpp"
#include "xfem/lab/report.hpp"
#include "xfem/meshing/grading.hpp"
#include "xfem/solve_frame.hpp"

namespace xfem {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// First failure is met from just above, so that rounding does not decide whether the crack starts.
constexpr double kJustAbove = 1e-9;

/// Finer where the loads of an even mesh act, if the test asks for it.
Mesh mesh_of(const LabSetup& setup, const common::LabTest& test) {
  Mesh even = make_mesh(setup.outline, test.mesh_nodes);
  if (!(test.mesh_grading > 1)) return even;
  MeshGrading grading{{}, test.mesh_grading};
  const IntactModel model(std::move(even), elastic_constants(test.material));
  for (const Load& load : setup.loads(model)) grading.points.push_back(load.point);
  return make_graded_mesh(setup.outline, test.mesh_nodes, grading);
}

/// The held loads, and the growing ones times a factor.
std::vector<Load> total(const std::vector<Load>& held, double factor, const std::vector<Load>& growing) {
  std::vector<Load> loads = held;
  for (const Load& load : growing) loads.push_back({load.point, factor * load.force});
  return loads;
}

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The result of the last of several equal runs, its times the medians of all.
LabResult timed_run(const LabSetup& setup, const common::LabTest& test, int repeats) {
  LabResult result;
  std::vector<double> seconds, set_up, analyses;
  for (int k = 0; k < repeats; ++k) {
    result = run(setup, test);
    seconds.push_back(result.seconds);
    set_up.push_back(result.cpu_seconds.set_up);
    analyses.push_back(result.cpu_seconds.analyses);
  }
  result.seconds = median(seconds);
  result.cpu_seconds = {median(set_up), median(analyses)};
  return result;
}

/// The cracks that the specimen has from the start.
std::vector<Crack> given_cracks(const Mesh& mesh, PolygonView outline, const common::SpecimenOptions& specimen) {
  std::vector<Crack> cracks;
  for (const auto& [from, to] : specimen.cracks) cracks.push_back(place_given_crack(mesh, outline, from, to));
  std::vector<int> owner(mesh.triangles.size(), -1);
  for (std::size_t c = 0; c < cracks.size(); ++c) {
    const std::vector<int> cut = cutting_cracks(mesh, {&cracks[c], 1});
    for (std::size_t t = 0; t < cut.size(); ++t) {
      if (cut[t] < 0) continue;
      if (owner[t] >= 0)
        throw common::bad_input(fmt::format(
            "specimen.cracks: found cracks {} and {} (counted from 0) in one element, expected cracks farther apart",
            owner[t], c));
      owner[t] = static_cast<int>(c);
    }
  }
  return cracks;
}

/// Factor of the growing loads at which a tip of the given cracks first advances; infinite if none does. Throws
/// bad_input if the held loads alone drive one: then there is no load at which the test would start.
double growth_factor(const ParticleModel& model, const std::vector<Load>& held, const std::vector<Load>& growing,
                     const std::vector<Crack>& cracks, const BreakageParameters& parameters) {
  if (cracks.empty()) return kInfinity;
  if (held.empty()) return first_growth(model, growing, cracks, parameters);
  // With held loads the field is not proportional to the factor: doubling, then halving the gap, to 1e-9.
  const auto grows = [&](double factor) {
    return first_growth(model, total(held, factor, growing), cracks, parameters) <= 1;
  };
  if (grows(0))
    throw common::bad_input(
        "specimen.cracks: found a crack that the held load alone drives, expected cracks that hold until the load "
        "grows");
  double high = 1e-3;
  for (int i = 0; i < 40 && !grows(high); ++i) high *= 2;
  if (!grows(high)) return kInfinity;
  double low = 0;
  for (int i = 0; i < 40; ++i) (grows((low + high) / 2) ? high : low) = (low + high) / 2;
  return high;
}

}  // namespace

LabSetup lab_setup(const common::LabTest& test) {
  using Kind = common::LabTestKind;
  LabSetup setup;
  switch (test.test) {
    case Kind::brazilian:
      setup = brazilian_test(test);
      break;
    case Kind::uniaxial:
      setup = uniaxial_test(test);
      break;
    case Kind::confined:
      setup = confined_test(test);
      break;
    case Kind::tension:
      setup = tension_test(test);
      break;
    case Kind::bending:
      setup = bending_test(test);
      break;
    case Kind::point_load:
      setup = point_load_test(test);
      break;
    case Kind::multi_contact:
      setup = multi_contact_test(test);
      break;
  }
  setup.test = name_of(test.test);
  // The discs know a theory of theirs.
  if (!test.specimen.cracks.empty() && test.test != Kind::brazilian && setup.theory_load) {
    setup.estimate = setup.theory_load;
    setup.estimate_source = "the specimen without its cracks";
    setup.theory_load.reset();
    setup.theory.clear();
  }
  return setup;
}

void require_loading(const common::LabTest& test, const std::vector<std::string>& used) {
  const common::LabLoading& given = test.loading;
  const common::LabLoading none;
  const auto check = [&](const std::string& name, bool is_default) {
    if (is_default || std::find(used.begin(), used.end(), name) != used.end()) return;
    throw common::bad_input(fmt::format("{}: loading.{}: found a value, expected none: a {} test does not use it",
                                        test.file.string(), name, name_of(test.test)));
  };
  check("confining_stress", given.confining_stress == none.confining_stress);
  check("platen_friction", given.platen_friction == none.platen_friction);
  check("patch", given.patch == none.patch);
  check("direction", given.direction == none.direction);
  check("contacts", given.contacts == none.contacts);
  check("friction", given.friction == none.friction);
  check("points", given.points.empty());
}

LabResult run(const LabSetup& setup, const common::LabTest& test) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = thread_cpu_seconds();
  BreakageParameters parameters = breakage_parameters(test.material, test.breakage, test.effects);
  parameters.load_patch = parameters.literal ? 0 : setup.load_patch;
  const ParticleModel model(setup.outline, mesh_of(setup, test), elastic_constants(test.material),
                            parameters.initiation_radius);
  const double set_up = thread_cpu_seconds() - cpu_start;
  const IntactModel& elastic = model.elastic;
  const double patch = parameters.load_patch * common::equivalent_diameter(model.area);

  LabResult result;
  result.cpu_seconds.set_up = set_up;
  result.rock = parameters.rock;
  result.mesh = elastic.mesh();
  std::vector<Vec2> centers;
  for (int e = 0; e < static_cast<int>(result.mesh.triangles.size()); ++e) centers.push_back(result.mesh.centroid(e));

  const std::vector<Load> growing = setup.loads(elastic);
  const std::vector<Load> held = setup.held ? setup.held(elastic) : std::vector<Load>();
  const auto field = [&](const std::vector<Load>& loads) {
    return elastic.stresses(elastic.solve(elastic.nodal_forces(loads, patch)));
  };
  const std::vector<Stress> unit = field(growing), constant = held.empty() ? std::vector<Stress>() : field(held);
  const std::vector<Stress> average = model.average(unit);
  const std::vector<Stress> constant_average = held.empty() ? std::vector<Stress>() : model.average(constant);
  const FirstFailure first = first_failure(parameters.rock, constant_average, average, centers);
  const auto load_at = [&](double factor) { return setup.held_load + factor * setup.unit_load; };
  std::vector<Crack> cracks = given_cracks(elastic.mesh(), model.outline, test.specimen);
  const double start_factor = std::min(first.factor, growth_factor(model, held, growing, cracks, parameters));
  const double shown = std::isfinite(start_factor) ? start_factor : 1;
  result.first_failure_load = load_at(start_factor);
  result.breakage_load = kInfinity;
  result.loads = total(held, shown, growing);
  result.element_stress = superposed(constant, shown, unit);
  result.averaged_stress = superposed(constant_average, shown, average);
  if (first.element >= 0) {
    result.first_failure_point = centers[first.element];
    const PrincipalStress p = principal(result.averaged_stress[first.element]);
    const bool tip_tears = parameters.toughness > 0 && start_factor < first.factor;
    result.first_failure_mode = tip_tears ? FailureMode::tension : parameters.rock.mode(p.s1, p.s3);
    const double least = start_factor * (1 + kJustAbove);
    const double analyses_start = thread_cpu_seconds();
    for (double factor = least; factor <= test.loading.largest * least; factor *= 1 + test.loading.step) {
      result.breakage = analyse(model, total(held, factor, growing), cracks, parameters);
      ++result.load_levels;
      result.growth_steps += result.breakage.growth_steps;
      if (result.breakage.status == common::ParticleStatus::broken) result.breakage_load = load_at(factor);
      if (result.breakage.status == common::ParticleStatus::broken ||
          result.breakage.status == common::ParticleStatus::refused)
        break;
      cracks = result.breakage.cracks;
    }
    result.cpu_seconds.analyses = thread_cpu_seconds() - analyses_start;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::string run_lab_test(const common::LabTest& test, const std::filesystem::path& directory, int repeats) {
  const LabSetup setup = lab_setup(test);
  const LabResult result = timed_run(setup, test, repeats);
  std::error_code failed;
  std::filesystem::create_directories(directory, failed);
  if (failed) throw common::io_failure(fmt::format("{}: {}", directory.string(), failed.message()));
  write_text(directory / "case.yaml", to_yaml(test));
  write_lab_result(directory / "result.h5", setup, result);
  write_text(directory / "specimen.svg", lab_figure(setup, result, test));
  write_text(directory / "summary.json", lab_summary(setup, result, test));
  const auto share = [&](double load) {
    return setup.theory_load ? fmt::format("{:.4f} of theory", load / *setup.theory_load)
                             : fmt::format("{:.4g} kN/m", load / 1e3);
  };
  const std::string breakage = std::isfinite(result.breakage_load)
                                   ? "breakage at " + share(result.breakage_load)
                                   : fmt::format("no breakage up to {:g} times that", test.loading.largest);
  return fmt::format("{}: first failure at {}, {}; {}", setup.test, share(result.first_failure_load), breakage,
                     (directory / "summary.json").string());
}

}  // namespace xfem
