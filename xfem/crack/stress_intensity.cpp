#include "xfem/crack/stress_intensity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "xfem/crack/growth.hpp"

namespace xfem {
namespace {

using common::cross;

/// Of the field of a unit K in the tip's frame.
struct NearTip {
  double s11, s22, s12;  ///< stress
  double e11, e22, e12;  ///< strain, tensor components
  double u11, u21;       ///< u_1,1 and u_2,1
};

struct Elastic {
  explicit Elastic(const ElasticConstants& c)
      : shear(c.young_modulus / (2 * (1 + c.poisson_ratio))),
        kappa(c.plane_stress ? (3 - c.poisson_ratio) / (1 + c.poisson_ratio) : 3 - 4 * c.poisson_ratio),
        lateral(c.plane_stress ? c.poisson_ratio / (1 + c.poisson_ratio) : c.poisson_ratio),
        modulus(c.plane_stress ? c.young_modulus : c.young_modulus / (1 - c.poisson_ratio * c.poisson_ratio)) {}
  double shear, kappa;
  double lateral;  ///< e_11 = (s_11 - lateral (s_11 + s_22)) / (2 shear)
  double modulus;  ///< E'
};

/// Williams' near-tip field at `x`. `side` +1 left, -1 right of the crack, 0 unknown: a point behind a tip keeps to its
/// side of the cut even where a kinked crack lets it stand beyond x_2 = 0.
NearTip near_tip(int mode, const Vec2& x, int side, const Elastic& elastic) {
  const double r = x.norm();
  const double cosine = x.x() / r;
  const double sine = x.y() / r;
  double c, s;  // cosine and sine of half the angle
  if (cosine >= 0) {
    c = std::sqrt(0.5 * (1 + cosine));
    s = 0.5 * sine / c;
  } else {
    s = std::sqrt(0.5 * (1 - cosine));
    c = 0.5 * sine / s;
    if (side < 0 || (side == 0 && sine < 0)) {
      s = -s;
      c = -c;
    }
  }
  const double s3 = s * (3 - 4 * s * s);
  const double c3 = c * (4 * c * c - 3);
  const double k = elastic.kappa;
  const double stress = 1 / std::sqrt(2 * std::numbers::pi * r);
  // u_i = sqrt(r / 2 pi) / (2 shear) g_i(angle); d_i is the derivative of g_i.
  NearTip f;
  double g1, d1, g2, d2;
  if (mode == 1) {
    f.s11 = stress * c * (1 - s * s3);
    f.s22 = stress * c * (1 + s * s3);
    f.s12 = stress * c * s * c3;
    g1 = c * (k - 1 + 2 * s * s);
    d1 = -0.5 * (k - 1) * s - s * s * s + 2 * c * c * s;
    g2 = s * (k + 1 - 2 * c * c);
    d2 = 0.5 * (k + 1) * c - c * c * c + 2 * s * s * c;
  } else {
    f.s11 = -stress * s * (2 + c * c3);
    f.s22 = stress * s * c * c3;
    f.s12 = stress * c * (1 - s * s3);
    g1 = s * (k + 1 + 2 * c * c);
    d1 = 0.5 * (k + 1) * c + c * c * c - 2 * s * s * c;
    g2 = -c * (k - 1 - 2 * s * s);
    d2 = 0.5 * (k - 1) * s - s * s * s + 2 * c * c * s;
  }
  const double scale = 1 / (2 * elastic.shear);
  f.u11 = stress * scale * (0.5 * cosine * g1 - sine * d1);
  f.u21 = stress * scale * (0.5 * cosine * g2 - sine * d2);
  const double lateral = elastic.lateral * (f.s11 + f.s22);
  f.e11 = scale * (f.s11 - lateral);
  f.e22 = scale * (f.s22 - lateral);
  f.e12 = scale * f.s12;
  return f;
}

/// The tip's frame.
struct Frame {
  Vec2 tip, axis;
  Vec2 operator()(const Vec2& v) const { return {axis.dot(v), cross(axis, v)}; }
};

/// Integrals of the two interaction terms over triangles of constant strain.
class Interaction {
 public:
  Interaction(const IntactModel& model, const Frame& frame)
      : frame_(frame), elastic_(model.constants()), matrix_(model.constants().matrix()) {}

  /// A triangle a, b, c on `side` of the crack; `displacement` gradient du_i / dx_j, `weight` gradient of q.
  void add(const Eigen::Matrix2d& displacement, const Vec2& weight, const std::array<Vec2, 3>& corners, int side) {
    Eigen::Matrix2d turn;
    turn << frame_.axis.x(), frame_.axis.y(), -frame_.axis.y(), frame_.axis.x();
    const Eigen::Matrix2d g = turn * displacement * turn.transpose();
    const Vec2 q = frame_(weight);
    const Eigen::Vector3d s = matrix_ * Eigen::Vector3d(g(0, 0), g(1, 1), g(0, 1) + g(1, 0));
    const double share = cross(corners[1] - corners[0], corners[2] - corners[0]) / 6;
    for (int point = 0; point < 3; ++point) {
      const Vec2 place = (4 * corners[point] + corners[(point + 1) % 3] + corners[(point + 2) % 3]) / 6;
      for (const int mode : {1, 2}) {
        const NearTip f = near_tip(mode, frame_(place - frame_.tip), side, elastic_);
        const double energy = s[0] * f.e11 + s[1] * f.e22 + 2 * s[2] * f.e12;
        const double x = s[0] * f.u11 + s[2] * f.u21 + f.s11 * g(0, 0) + f.s12 * g(1, 0) - energy;
        const double y = s[2] * f.u11 + s[1] * f.u21 + f.s12 * g(0, 0) + f.s22 * g(1, 0);
        sum_[mode - 1] += share * (x * q.x() + y * q.y());
      }
    }
  }

  double intensity(int mode) const { return elastic_.modulus / 2 * sum_[mode - 1]; }

 private:
  Frame frame_;
  Elastic elastic_;
  Eigen::Matrix3d matrix_;
  std::array<double, 2> sum_{0, 0};
};

/// The weight at every node; empty if the tip itself does not get a full one.
std::vector<double> weights(const Mesh& mesh, std::span<const Crack> cracks, int crack, int end) {
  const auto& points = cracks[crack].points;
  const CrackPoint& tip = end == 1 ? points.back() : points.front();
  const double size = element_size(mesh, tip);
  std::vector<double> weight(mesh.nodes.size());
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double distance = (mesh.nodes[i] - tip.position).norm() / size;
    weight[i] = std::clamp((kRingOutside - distance) / (kRingOutside - kRingInside), 0.0, 1.0);
  }
  const auto keep_off = [&](int element) {
    for (const int node : mesh.triangles[element]) weight[node] = 0;
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbours[t][k] >= 0) continue;
      weight[mesh.triangles[t][(k + 1) % 3]] = weight[mesh.triangles[t][(k + 2) % 3]] = 0;
    }
  }
  for (int c = 0; c < static_cast<int>(cracks.size()); ++c) {
    const auto& other = cracks[c].points;
    const std::size_t first = c == crack && end == 0 ? other.size() - 1 : 1;
    const std::size_t last = c == crack && end == 1 ? 1 : other.size() - 1;
    for (std::size_t i = first; i <= last; ++i) keep_off(segment_element(mesh, other[i - 1], other[i]));
  }
  for (const int element : edge_elements(mesh, tip.edge)) {
    if (element < 0) return {};
    for (const int node : mesh.triangles[element]) {
      if (weight[node] == 0) return {};
    }
  }
  return weight;
}

/// What closed faces do to the K of a tip.
struct FaceShare {
  std::array<double, 2> intensity{0, 0};
  bool closed_at_tip = false;
};

/// K that the tractions on closed faces add: a pair of opposite forces P on the faces at a distance r behind the tip
/// gives 2 P / sqrt(2 pi r) (the weight function of a straight crack), counted as far as q reaches.
FaceShare from_faces(const IntactModel& model, const CrackedState& state, const Frame& frame, int crack, int end,
                     const std::vector<double>& weight) {
  const Mesh& mesh = model.mesh();
  const double penalty = kFacePenalty * model.constants().young_modulus / mesh.size;
  FaceShare share;
  // The penalties of short segments beside one another scatter: their mean over the ring counts.
  double reach = 0, length = 0, pressure = 0, shear = 0;
  double nearest = std::numeric_limits<double>::infinity();
  const std::vector<FaceSegment> faces = face_segments(mesh, model.gradients(), state.enrichment);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const CrackSegment& segment = state.enrichment.segments[faces[i].segment];
    if (segment.crack != crack) continue;
    const double gap = opening(faces[i], state.q);
    const Vec2 middle = (segment.first.position + segment.last.position) / 2;
    const double distance = (middle - frame.tip).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      share.closed_at_tip = gap < 0;
    }
    if (gap >= 0) continue;
    const Vec2 place = middle - mesh.centroid(segment.element);
    double q = 0;
    for (int k = 0; k < 3; ++k) {
      const double shape = 1.0 / 3 + model.gradients()[segment.element].gradient[k].dot(place);
      q += shape * weight[mesh.triangles[segment.element][k]];
    }
    const CrackPoint& near = end == 1 ? segment.last : segment.first;
    const CrackPoint& far = end == 1 ? segment.first : segment.last;
    const double r1 = std::max(0.0, -frame(near.position - frame.tip).x());
    const double r2 = std::max(r1, -frame(far.position - frame.tip).x());
    const double force = q * std::sqrt(2 / std::numbers::pi) * 2 * (std::sqrt(r2) - std::sqrt(r1));
    if (!(force > 0)) continue;
    reach += force;
    length += faces[i].length;
    pressure -= penalty * gap * faces[i].length;
    if (!state.face_shear.empty()) shear += state.face_shear[i] * faces[i].length;
  }
  if (length > 0) share.intensity = {pressure / length * reach, -shear / length * reach};
  return share;
}

}  // namespace

double element_size(const Mesh& mesh, const CrackPoint& tip) {
  double area = 0;
  int count = 0;
  for (const int node : tip.edge) {
    for (int i = mesh.element_offset[node]; i < mesh.element_offset[node + 1]; ++i) {
      area += mesh.areas[mesh.node_elements[i]];
      ++count;
    }
  }
  return std::sqrt(4 / std::sqrt(3.0) * area / count);
}

std::optional<StressIntensity> stress_intensity(const IntactModel& model, const CrackedState& state,
                                                std::span<const Crack> cracks, int crack, int end) {
  const Mesh& mesh = model.mesh();
  const std::vector<double> weight = weights(mesh, cracks, crack, end);
  if (weight.empty()) return std::nullopt;
  const CrackPoint& tip = end == 1 ? cracks[crack].points.back() : cracks[crack].points.front();
  const Frame frame{tip.position, tip_direction(oriented(cracks[crack], end), kRingOutside * element_size(mesh, tip))};
  const int left = end == 1 ? 1 : -1;  // of the crack as it is stored, looking out of this end

  Interaction interaction(model, frame);
  auto cut = state.enrichment.cut.begin();
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    while (cut != state.enrichment.cut.end() && cut->element < t) ++cut;
    const auto& triangle = mesh.triangles[t];
    if (weight[triangle[0]] == weight[triangle[1]] && weight[triangle[1]] == weight[triangle[2]]) continue;
    const auto& gradient = model.gradients()[t].gradient;
    Vec2 slope = Vec2::Zero();
    Eigen::Matrix2d common_part = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 3; ++k) {
      slope += weight[triangle[k]] * gradient[k];
      common_part += Vec2(state.u[2 * triangle[k]], state.u[2 * triangle[k] + 1]) * gradient[k].transpose();
    }
    if (cut == state.enrichment.cut.end() || cut->element != t) {
      interaction.add(common_part, slope, {mesh.nodes[triangle[0]], mesh.nodes[triangle[1]], mesh.nodes[triangle[2]]},
                      0);
      continue;
    }
    for (const ElementPart& part : cut->parts) {
      Eigen::Matrix2d displacement = common_part;
      for (const CutElement::Term& term : cut->terms) {
        const Vec2 jump =
            state.enrichment.jump(term, part) * Vec2(state.q[2 * term.function], state.q[2 * term.function + 1]);
        displacement += jump * gradient[term.local].transpose();
      }
      int side = 0;
      for (std::size_t slot = 0; slot < cut->segments.size(); ++slot) {
        if (state.enrichment.segments[cut->segments[slot]].crack == crack) side = left * part.side[slot];
      }
      const Polygon corners = outline(mesh, t, part);
      for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        interaction.add(displacement, slope, {corners[0], corners[k], corners[k + 1]}, side);
      }
    }
  }
  const FaceShare faces = from_faces(model, state, frame, crack, end, weight);
  return StressIntensity{faces.closed_at_tip ? 0 : interaction.intensity(1) + faces.intensity[0],
                         interaction.intensity(2) + faces.intensity[1], frame.axis};
}

}  // namespace xfem
