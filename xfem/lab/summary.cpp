#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "common/io/immutable_file.hpp"
#include "xfem/lab/report.hpp"

namespace xfem {

namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: what was never reached is null.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
Json point(const Vec2& p) {
  return {p.x(), p.y()};
}

const char* name_of(common::ParticleStatus status) {
  switch (status) {
    case common::ParticleStatus::broken:
      return "broken";
    case common::ParticleStatus::refused:
      return "refused";
    default:
      return "arrested";
  }
}

const char* name_of(FailureMode mode) {
  switch (mode) {
    case FailureMode::tension:
      return "tension";
    case FailureMode::shear:
      return "shear";
    default:
      return "none";
  }
}

/// Angle between a line and the load axis (y) [degrees], 0 to 90.
double angle_degrees(const Vec2& line) {
  return std::atan2(std::abs(line.x()), std::abs(line.y())) * 180 / std::numbers::pi;
}

/// Of the crack's segment whose middle is nearest to the point of first failure: the plane on which it started.
std::optional<double> initiation_angle_degrees(const LabResult& result) {
  std::optional<double> angle;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Crack& crack : result.breakage.cracks)
    for (std::size_t i = 1; i < crack.points.size(); ++i) {
      const Vec2 &a = crack.points[i - 1].position, &b = crack.points[i].position;
      const double distance = (0.5 * (a + b) - result.first_failure_point).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      angle = angle_degrees(b - a);
    }
  return angle;
}

Json optional_number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

/// The longest crack, as a polyline.
Json crack_path(const std::vector<Crack>& cracks) {
  Json longest = Json::array();
  double length = 0;
  for (const Crack& crack : cracks) {
    Json points = Json::array();
    double sum = 0;
    for (std::size_t i = 0; i < crack.points.size(); ++i) {
      points.push_back(point(crack.points[i].position));
      if (i > 0) sum += (crack.points[i].position - crack.points[i - 1].position).norm();
    }
    if (sum > length) {
      longest = std::move(points);
      length = sum;
    }
  }
  return longest;
}

}  // namespace

std::optional<double> fracture_angle_degrees(const BreakageResult& result) {
  if (!result.path) return std::nullopt;
  return angle_degrees((*result.path)[1] - (*result.path)[0]);
}

std::string lab_summary(const LabSetup& setup, const LabResult& result, const common::LabTest& test) {
  Json summary;
  summary["schema"] = "lab/1";
  summary["test"] = setup.test;
  summary["config_hash"] = common::config_hash(test);
  summary["rock"] = {{"name", test.material.name},
                     {"sigma_ci", test.material.sigma_ci},
                     {"m_i", test.material.m_i},
                     {"young_modulus", test.material.young_modulus},
                     {"poisson_ratio", test.material.poisson_ratio}};
  for (const auto& [name, value] : setup.dimensions) summary["specimen"][name] = value;
  summary["specimen"]["area"] = common::area(setup.outline);
  summary["mesh"] = {{"nodes", result.mesh.nodes.size()}, {"elements", result.mesh.triangles.size()}};
  const auto ratio = [&](double load) { return setup.theory_load ? number(load / *setup.theory_load) : Json(nullptr); };
  summary["analytical"] = nullptr;
  if (setup.theory_load) {
    summary["analytical"] = {{"breakage_load", *setup.theory_load}};
    for (const auto& [name, value] : setup.theory) summary["analytical"][name] = value;
  }
  summary["reference"] = nullptr;
  if (setup.estimate) summary["reference"] = {{"breakage_load", *setup.estimate}, {"estimate", setup.estimate_source}};
  summary["held_load"] = setup.held_load;
  summary["first_failure_load"] = number(result.first_failure_load);
  summary["breakage_load"] = number(result.breakage_load);
  summary["ratio"] = ratio(result.breakage_load);
  summary["ratio_first_failure"] = ratio(result.first_failure_load);
  if (setup.theory_load && summary["analytical"].contains("tensile_load")) {
    const double tensile = summary["analytical"]["tensile_load"];
    summary["ratio_tensile"] = {{"first_failure", number(result.first_failure_load / tensile)},
                                {"breakage", number(result.breakage_load / tensile)}};
  }
  summary["load_step"] = test.loading.step;
  summary["first_failure_point"] = point(result.first_failure_point);
  summary["failure_mode"] = name_of(result.first_failure_mode);
  summary["crack_path"] = crack_path(result.breakage.cracks);
  summary["breakage_line"] = Json::array();
  if (result.breakage.path)
    for (const Vec2& end : *result.breakage.path) summary["breakage_line"].push_back(point(end));
  summary["fracture_angle_deg"] = optional_number(fracture_angle_degrees(result.breakage));
  summary["initiation_angle_deg"] = optional_number(initiation_angle_degrees(result));
  summary["fragments"] = Json::array();
  if (result.breakage.path)
    for (const Polygon* fragment : {&result.breakage.left, &result.breakage.right})
      summary["fragments"].push_back({{"area", common::area(*fragment)}});
  summary["growth_steps"] = result.growth_steps;
  summary["status"] = name_of(result.breakage.status);
  if (!result.breakage.reason.empty()) summary["reason"] = result.breakage.reason;
  summary["load_levels"] = result.load_levels;
  const double analysis = result.load_levels > 0 ? result.cpu_seconds.analyses / result.load_levels : 0;
  summary["cpu_seconds"] = {{"set_up", result.cpu_seconds.set_up},
                            {"analysis", analysis},
                            {"particle", result.cpu_seconds.set_up + analysis}};
  summary["seconds"] = result.seconds;
  return summary.dump(2) + "\n";
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  common::write_atomically(file, std::as_bytes(std::span(text)), {});
}

}  // namespace xfem
