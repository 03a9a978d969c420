// Averages of element stresses, and the mean stress without a mesh.
#include <algorithm>
#include <cmath>

#include "xfem/elasticity/intact_model.hpp"
#include "xfem/elasticity/loads.hpp"

namespace xfem {
namespace {

/// Centre of the disc over which an element's stress is averaged: the middle of its edge on the boundary (the longer of
/// two), else its centroid. Contact forces act on the boundary and particles fail first beside them: discs that only
/// came as near as the centroids do would miss the worst place, the more the coarser the mesh.
Vec2 disc_center(const Mesh& mesh, int t) {
  double longest = 0;
  Vec2 center = mesh.centroid(t);
  for (int k = 0; k < 3; ++k) {
    if (mesh.neighbours[t][k] >= 0) continue;
    const Vec2& a = mesh.nodes[mesh.triangles[t][(k + 1) % 3]];
    const Vec2& b = mesh.nodes[mesh.triangles[t][(k + 2) % 3]];
    const double length = (b - a).squaredNorm();
    if (length <= longest) continue;
    longest = length;
    center = 0.5 * (a + b);
  }
  return center;
}

}  // namespace

StressAverage::StressAverage(const Mesh& mesh, double radius) {
  const int elements = static_cast<int>(mesh.triangles.size());
  // Sorted by x, so that only a strip of candidates is looked at.
  struct Place {
    double x, y;
    int element;
  };
  std::vector<Place> candidates(elements), discs(elements);
  double reach = radius;  // an element belongs to its own disc, whatever the radius
  for (int t = 0; t < elements; ++t) {
    const Vec2 centroid = mesh.centroid(t), center = disc_center(mesh, t);
    candidates[t] = {centroid.x(), centroid.y(), t};
    discs[t] = {center.x(), center.y(), t};
    reach = std::max(reach, std::abs(center.x() - centroid.x()));
  }
  for (std::vector<Place>* places : {&candidates, &discs})
    std::sort(places->begin(), places->end(),
              [](const Place& a, const Place& b) { return a.x != b.x ? a.x < b.x : a.element < b.element; });
  // First by sorted element, while the strip moves on with it.
  std::vector<int> first(elements), count(elements), found;
  std::size_t left = 0, right = 0;
  for (const Place& own : discs) {
    while (candidates[left].x < own.x - reach) ++left;
    first[own.element] = static_cast<int>(found.size());
    while (right < candidates.size() && candidates[right].x <= own.x + reach) ++right;
    // Every candidate is written, only the near ones stay: no branch to mispredict.
    std::size_t end = found.size();
    found.resize(end + right - left);
    for (std::size_t k = left; k < right; ++k) {
      const double dx = candidates[k].x - own.x, dy = candidates[k].y - own.y;
      found[end] = candidates[k].element;
      end += (dx * dx + dy * dy <= radius * radius) | (candidates[k].element == own.element);
    }
    found.resize(end);
    count[own.element] = static_cast<int>(end) - first[own.element];
  }
  offset_.reserve(elements + 1);
  element_.reserve(found.size());
  weight_.reserve(found.size());
  offset_.push_back(0);
  for (int t = 0; t < elements; ++t) {
    double sum = 0;
    for (int k = first[t]; k < first[t] + count[t]; ++k) sum += mesh.areas[found[k]];
    for (int k = first[t]; k < first[t] + count[t]; ++k) {
      element_.push_back(found[k]);
      weight_.push_back(mesh.areas[found[k]] / sum);
    }
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

SecondMoments second_moments(PolygonView outline) {
  // A fan of triangles (0, p, q) about the centroid, each A / 12 (p (x) p + q (x) q + (p + q) (x) (p + q)).
  SecondMoments result{0, common::centroid(outline), 0, 0, 0};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 p = outline[i] - result.center;
    const Vec2 q = outline[(i + 1) % outline.size()] - result.center;
    const Vec2 r = p + q;
    const double part = 0.5 * common::cross(p, q);
    result.area += part;
    result.xx += part / 12 * (p.x() * p.x() + q.x() * q.x() + r.x() * r.x());
    result.yy += part / 12 * (p.y() * p.y() + q.y() * q.y() + r.y() * r.y());
    result.xy += part / 12 * (p.x() * p.y() + q.x() * q.y() + r.x() * r.y());
  }
  return result;
}

Stress Virial::stress() const {
  // The body force -(a + rotation perpendicular(x)): its uniform part has no virial about the centroid.
  const double rotation = moment_ / (moments_.xx + moments_.yy);
  const double xx = xx_ + rotation * moments_.xy;
  const double yy = yy_ - rotation * moments_.xy;
  const double xy = xy_ + 0.5 * rotation * (moments_.yy - moments_.xx);
  return {-xx / moments_.area, -yy / moments_.area, -xy / moments_.area};
}

Stress virial_stress(std::span<const Load> loads, PolygonView outline, double patch) {
  const SecondMoments moments = second_moments(outline);
  const BoundaryLoop loop(outline);
  Virial virial(moments);
  for (const Load& load : loads) {
    for (const BoundaryShare& share : boundary_shares(outline, loop, load, patch)) {
      const Vec2& from = outline[share.edge];
      const Vec2& to = outline[(share.edge + 1) % outline.size()];
      virial.add(from + share.position * (to - from), share.weight * load.force);
    }
  }
  return virial.stress();
}

}  // namespace xfem
