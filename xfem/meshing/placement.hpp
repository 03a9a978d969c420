// Where the nodes of a mesh stand before smoothing: graded points on the outline, a hexagonal lattice inside.
#pragma once

#include <utility>
#include <vector>

#include "common/geometry/polygon.hpp"
#include "xfem/meshing/grading.hpp"

namespace xfem {

/// Wanted edge length at a point: h, less near outline edges shorter than h and near the points of a grading,
///   s(x) = min(h, max(h / 8, min over edges (length + 0.8 distance), min over points (h / ratio + 0.3 distance))).
class SizeField {
 public:
  SizeField(common::PolygonView outline, double h, const MeshGrading& grading = {});
  double operator()(const common::Vec2& point) const;
  bool uniform() const { return fine_.empty(); }
  double h() const { return h_; }

  /// Around which the mesh is finer.
  struct Segment {
    common::Vec2 from, to;
    double length, growth;
  };
  const std::vector<Segment>& fine() const { return fine_; }

 private:
  double h_;
  std::vector<Segment> fine_;
};

/// Distance of a point from a segment [m].
double segment_distance(const common::Vec2& point, const common::Vec2& from, const common::Vec2& to);

struct Placement {
  std::vector<common::Vec2> points;  ///< boundary points first, counter-clockwise from outline vertex 0
  /// For each boundary point its outline edge and its position on it, in [0, 1); 0 is the vertex itself.
  std::vector<std::pair<int, double>> on_edge;
};

/// Points for the size field; the lattice is aligned with the longest edge and shifted by `shift` (in lattice
/// vectors, relative to the origin). The outline contains the origin.
Placement place_points(common::PolygonView outline, const SizeField& size, const common::Vec2& shift);

}  // namespace xfem
