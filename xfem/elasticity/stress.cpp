// Averages of element stresses, and the mean stress without a mesh.
#include <algorithm>

#include "xfem/elasticity/intact_model.hpp"
#include "xfem/elasticity/loads.hpp"

namespace xfem {

StressAverage::StressAverage(const Mesh& mesh, double radius) {
  const int elements = static_cast<int>(mesh.triangles.size());
  std::vector<Vec2> centroid(elements);
  for (int t = 0; t < elements; ++t) centroid[t] = mesh.centroid(t);
  // Sorted by x, so that only a strip of candidates is looked at.
  std::vector<int> order(elements);
  for (int t = 0; t < elements; ++t) order[t] = t;
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return centroid[a].x() != centroid[b].x() ? centroid[a].x() < centroid[b].x() : a < b;
  });
  offset_.push_back(0);
  for (int t = 0; t < elements; ++t) {
    const std::size_t first = element_.size();
    auto candidate = std::lower_bound(order.begin(), order.end(), centroid[t].x() - radius,
                                      [&](int e, double x) { return centroid[e].x() < x; });
    for (; candidate != order.end() && centroid[*candidate].x() <= centroid[t].x() + radius; ++candidate) {
      if ((centroid[*candidate] - centroid[t]).squaredNorm() <= radius * radius) element_.push_back(*candidate);
    }
    double sum = 0;
    for (std::size_t k = first; k < element_.size(); ++k) sum += mesh.areas[element_[k]];
    for (std::size_t k = first; k < element_.size(); ++k) weight_.push_back(mesh.areas[element_[k]] / sum);
    offset_.push_back(static_cast<int>(element_.size()));
  }
}

std::vector<Stress> StressAverage::operator()(std::span<const Stress> element_stress) const {
  std::vector<Stress> result(element_stress.size());
  for (std::size_t t = 0; t < result.size(); ++t) {
    for (int k = offset_[t]; k < offset_[t + 1]; ++k) {
      const Stress& s = element_stress[element_[k]];
      result[t].xx += weight_[k] * s.xx;
      result[t].yy += weight_[k] * s.yy;
      result[t].xy += weight_[k] * s.xy;
    }
  }
  return result;
}

Stress mean_stress(const Mesh& mesh, std::span<const Stress> element_stress) {
  Stress sum;
  double area = 0;
  for (std::size_t t = 0; t < element_stress.size(); ++t) {
    area += mesh.areas[t];
    sum.xx += mesh.areas[t] * element_stress[t].xx;
    sum.yy += mesh.areas[t] * element_stress[t].yy;
    sum.xy += mesh.areas[t] * element_stress[t].xy;
  }
  return {sum.xx / area, sum.yy / area, sum.xy / area};
}

Stress virial_stress(std::span<const Load> loads, PolygonView outline, double patch) {
  // Integrals of x x, x y, y y about the centroid: a fan of triangles (0, p, q), each
  // A / 12 (p (x) p + q (x) q + (p + q) (x) (p + q)).
  const Vec2 center = common::centroid(outline);
  double area = 0, moment_xx = 0, moment_yy = 0, moment_xy = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 p = outline[i] - center;
    const Vec2 q = outline[(i + 1) % outline.size()] - center;
    const Vec2 r = p + q;
    const double part = 0.5 * common::cross(p, q);
    area += part;
    moment_xx += part / 12 * (p.x() * p.x() + q.x() * q.x() + r.x() * r.x());
    moment_yy += part / 12 * (p.y() * p.y() + q.y() * q.y() + r.y() * r.y());
    moment_xy += part / 12 * (p.x() * p.y() + q.x() * q.y() + r.x() * r.y());
  }
  const std::vector<Vec2> forces = boundary_forces(outline, loads, patch);
  const double rotation = rigid_acceleration(outline, forces, area, center, moment_xx + moment_yy).angular;
  Stress sum;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 x = outline[i] - center;
    sum.xx += forces[i].x() * x.x();
    sum.yy += forces[i].y() * x.y();
    sum.xy += 0.5 * (forces[i].x() * x.y() + forces[i].y() * x.x());
  }
  // The body force -(a + rotation perpendicular(x)): its uniform part has no virial about the centroid.
  sum.xx += rotation * moment_xy;
  sum.yy -= rotation * moment_xy;
  sum.xy += 0.5 * rotation * (moment_yy - moment_xx);
  return {-sum.xx / area, -sum.yy / area, -sum.xy / area};
}

}  // namespace xfem
