#include "xfem/crack/edge_loads.hpp"

#include <algorithm>

#include "common/geometry/vec2.hpp"

namespace xfem {

EdgeLoads::EdgeLoads(const IntactModel& model, std::span<const Load> loads, double patch)
    : mesh_(&model.mesh()),
      loads_(loads.begin(), loads.end()),
      patch_(patch),
      loop_(model.boundary()),
      points_(model.boundary_points()),
      body_(model.inertia_relief(loads, patch)) {}

Eigen::VectorXd EdgeLoads::forces(const Enrichment& enrichment) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(enrichment.functions.size()));
  for (const CutElement& element : enrichment.cut) {
    const auto& triangle = mesh_->triangles[element.element];
    for (const CutElement::Term& term : element.terms) {
      Vec2 sum = Vec2::Zero();
      for (const ElementPart& part : element.parts) {
        const double jump = enrichment.jump(term, part);
        if (jump != 0) sum += jump * integrate_body_force(element.element, term.local, part);
      }
      // A load on the cut edge of a mouth: only beyond the mouth, as seen from the function's node, is H - H_J not 0.
      const CrackSegment& segment = enrichment.segments[element.segments[term.slot]];
      for (const CrackPoint* end : {&segment.first, &segment.last}) {
        const int node = triangle[term.local];
        if ((end->edge[0] != node && end->edge[1] != node) || !on_boundary(*mesh_, *end)) continue;
        sum += -2.0 * enrichment.functions[term.function].side * beyond_mouth(*end, node);
      }
      result[2 * term.function] += sum.x();
      result[2 * term.function + 1] += sum.y();
    }
  }
  return result;
}

Vec2 EdgeLoads::body_force(const Vec2& position) const {
  return -(body_.linear + body_.angular * common::perpendicular(position - body_.center));
}

/// Integral over a part of N b, exact: both are linear, and three mid-edge points integrate a quadratic exactly.
Vec2 EdgeLoads::integrate_body_force(int element, int local, const ElementPart& part) const {
  const auto& triangle = mesh_->triangles[element];
  std::array<Vec2, 3> at_node;
  for (int k = 0; k < 3; ++k) at_node[k] = body_force(mesh_->nodes[triangle[k]]);
  Vec2 sum = Vec2::Zero();
  const auto add_middle = [&](double weight, const Barycentric& a, const Barycentric& b) {
    const double shape = weight * (a[local] + b[local]) / 4;
    for (int k = 0; k < 3; ++k) sum += shape * (a[k] + b[k]) * at_node[k];
  };
  for (std::size_t i = 1; i + 1 < part.corners.size(); ++i) {
    const Barycentric &a = part.corners[0], &b = part.corners[i], &c = part.corners[i + 1];
    const double weight = area_fraction(a, b, c) * mesh_->areas[element] / 3;
    add_middle(weight, a, b);
    add_middle(weight, b, c);
    add_middle(weight, c, a);
  }
  return sum;
}

Vec2 EdgeLoads::beyond_mouth(const CrackPoint& mouth, int node) const {
  std::vector<Vec2> loop = points_;
  const int n = static_cast<int>(loop_.size());
  int edge = 0;
  while (std::minmax(loop_[edge], loop_[(edge + 1) % n]) != std::minmax(mouth.edge[0], mouth.edge[1])) ++edge;
  const bool starts_at_node = loop_[edge] == node;
  int beyond = edge;
  // N_J falls linearly from its value at the mouth to 0 at the other end.
  double at_mouth = 1;
  if (mouth.position == points_[edge] || mouth.position == points_[(edge + 1) % n]) {
    // Nearer to a node than rounding tells: all of the edge is beyond it as seen from there, nothing from the other.
    if (starts_at_node != (mouth.position == points_[edge])) return Vec2::Zero();
  } else {
    // The mouth becomes a point of the loop, so that no share of a load straddles it.
    loop.insert(loop.begin() + edge + 1, mouth.position);
    if (starts_at_node) ++beyond;
    at_mouth = mouth.edge[0] == node ? 1 - mouth.fraction : mouth.fraction;
  }
  Vec2 sum = Vec2::Zero();
  for (const Load& load : loads_) {
    for (const BoundaryShare& share : boundary_shares(loop, load, patch_)) {
      if (share.edge != beyond) continue;
      sum += at_mouth * (starts_at_node ? 1 - share.position : share.position) * share.weight * load.force;
    }
  }
  return sum;
}

}  // namespace xfem
