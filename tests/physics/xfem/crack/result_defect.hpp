// What holds for every result of an analysis, whatever the particle, its loads and its cracks.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "xfem/breakage.hpp"

namespace result_check {

inline bool same_cracks(const std::vector<xfem::Crack>& a, const std::vector<xfem::Crack>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (a[c].tips != b[c].tips || a[c].points.size() != b[c].points.size()) return false;
    for (std::size_t i = 0; i < a[c].points.size(); ++i) {
      const xfem::CrackPoint &p = a[c].points[i], &q = b[c].points[i];
      if (p.edge != q.edge || p.fraction != q.fraction || p.position != q.position) return false;
    }
  }
  return true;
}

/// Empty if the result makes sense; otherwise the first thing that is wrong. `stored`: cracks that the particle had.
inline std::string result_defect(const xfem::ParticleModel& model, const xfem::BreakageResult& result,
                                 const xfem::BreakageParameters& parameters, std::size_t stored = 0) {
  const xfem::Mesh& mesh = model.elastic.mesh();
  if (!std::isfinite(result.mean_stress.xx + result.mean_stress.yy + result.mean_stress.xy)) return "stress not finite";
  if (result.growth_steps > 4 * static_cast<int>(mesh.triangles.size()) + 1) return "too many growth steps";
  if (result.cracks.size() > std::max(stored, static_cast<std::size_t>(parameters.max_cracks)))
    return "too many cracks";
  for (const xfem::Crack& crack : result.cracks) {
    if (const std::string defect = crack_defect(mesh, crack); !defect.empty()) return "a crack: " + defect;
  }
  if (result.status != common::ParticleStatus::broken) {
    return result.path || !result.left.empty() || !result.right.empty() ? "fragments of what is not broken" : "";
  }
  if (!result.path) return "broken without a path";
  const double left = common::area(result.left), right = common::area(result.right);
  if (!(std::abs(left + right - model.area) <= 1e-12 * model.area)) return "the pieces do not fill the particle";
  if (std::min(left, right) < parameters.minimum_fragment * model.area) return "a piece is too small";
  for (const common::Polygon* piece : {&result.left, &result.right}) {
    if (const std::string defect = common::outline_defect(*piece); !defect.empty()) return "a piece: " + defect;
  }
  return {};
}

/// True if an element carries two cracks. Growth makes none: a tip stops before another crack.
inline bool cuts_twice(const xfem::Mesh& mesh, const std::vector<xfem::Crack>& cracks) {
  std::vector<int> cuts(mesh.triangles.size(), 0);
  for (const xfem::Crack& crack : cracks) {
    for (std::size_t i = 1; i < crack.points.size(); ++i) {
      if (++cuts[segment_element(mesh, crack.points[i - 1], crack.points[i])] > 1) return true;
    }
  }
  return false;
}

}  // namespace result_check
