#include "xfem/meshing/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace xfem {

using common::PolygonView;
using common::Vec2;

namespace {

constexpr double kGrading = 0.8;       // growth of the edge length with the distance from a short edge
constexpr double kFocusGrading = 0.3;  // and from a point at which the mesh is to be finer
constexpr double kFinest = 1.0 / 8;    // smallest wanted edge length, in h
constexpr double kClearance = 0.62;    // of lattice points from the outline, in local edge lengths
constexpr double kSeparation = 0.75;   // of lattice points of different levels, in local edge lengths
constexpr int kLevels = 4;             // of lattices, each of half the spacing
constexpr int kSamples = 32;           // of the size field along an edge

/// Splits the edge at equal steps of the integral of 1 / size; positions in [0, 1), the first 0.
std::vector<double> subdivide(const Vec2& from, const Vec2& to, const SizeField& size) {
  const double length = (to - from).norm();
  if (size.uniform()) {
    const int pieces = std::max(1, static_cast<int>(std::floor(length / size.h() + 0.5)));
    std::vector<double> result;
    for (int k = 0; k < pieces; ++k) result.push_back(static_cast<double>(k) / pieces);
    return result;
  }
  std::vector<double> integral(kSamples + 1, 0.0);
  for (int k = 0; k < kSamples; ++k) {
    const double middle = (k + 0.5) / kSamples;
    integral[k + 1] = integral[k] + length / kSamples / size(from + middle * (to - from));
  }
  const int pieces = std::max(1, static_cast<int>(std::floor(integral[kSamples] + 0.5)));
  std::vector<double> result{0.0};
  int cell = 0;
  for (int k = 1; k < pieces; ++k) {
    const double wanted = integral[kSamples] * k / pieces;
    while (integral[cell + 1] < wanted) ++cell;
    result.push_back((cell + (wanted - integral[cell]) / (integral[cell + 1] - integral[cell])) / kSamples);
  }
  return result;
}

/// The lines that bound a convex outline.
class HalfPlanes {
 public:
  explicit HalfPlanes(PolygonView outline) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
      const Vec2 inward = common::perpendicular(edge) / edge.norm();
      planes_.push_back({inward, inward.dot(outline[i])});
    }
  }
  /// Distance of an inner point from the outline; negative outside.
  double depth(const Vec2& point) const {
    double result = planes_[0].inward.dot(point) - planes_[0].offset;
    for (const Plane& plane : planes_) result = std::min(result, plane.inward.dot(point) - plane.offset);
    return result;
  }

 private:
  struct Plane {
    Vec2 inward;
    double offset;
  };
  std::vector<Plane> planes_;
};

/// The smallest box around some points, in any orthonormal axes.
struct Box {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec2& point, double reach) {
    low = low.cwiseMin(point - Vec2::Constant(reach));
    high = high.cwiseMax(point + Vec2::Constant(reach));
  }
};

Vec2 longest_edge_direction(PolygonView outline) {
  Vec2 result(1, 0);
  double longest = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    // The margin makes equal lengths (regular polygons) fall on the first edge whatever the rounding.
    if (edge.norm() > longest * (1 + 1e-6)) {
      longest = edge.norm();
      result = edge / longest;
    }
  }
  return result;
}

}  // namespace

double segment_distance(const Vec2& point, const Vec2& from, const Vec2& to) {
  const Vec2 edge = to - from;
  const double squared = edge.squaredNorm();
  const double t = squared > 0 ? std::clamp((point - from).dot(edge) / squared, 0.0, 1.0) : 0;
  return (point - from - t * edge).norm();
}

SizeField::SizeField(PolygonView outline, double h, const MeshGrading& grading) : h_(h) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2& to = outline[(i + 1) % outline.size()];
    const double length = (to - outline[i]).norm();
    if (length < 0.75 * h) fine_.push_back({outline[i], to, length, kGrading});
  }
  if (!(grading.ratio > 1)) return;
  for (const Vec2& point : grading.points) fine_.push_back({point, point, h / grading.ratio, kFocusGrading});
}

double SizeField::operator()(const Vec2& point) const {
  double result = h_;
  for (const Segment& edge : fine_) {
    result = std::min(result, edge.length + edge.growth * segment_distance(point, edge.from, edge.to));
  }
  return std::max(result, kFinest * h_);
}

Placement place_points(PolygonView outline, const SizeField& size, const Vec2& shift) {
  Placement result;
  const std::size_t corners = outline.size();
  for (std::size_t i = 0; i < corners; ++i) {
    const Vec2& to = outline[(i + 1) % corners];
    for (const double t : subdivide(outline[i], to, size)) {
      result.points.push_back(outline[i] + t * (to - outline[i]));
      result.on_edge.emplace_back(static_cast<int>(i), t);
    }
  }

  // Lattices of spacing h, h/2, h/4, h/8, the finest first; each serves where the wanted edge length is nearest to it.
  const Vec2 along = longest_edge_direction(outline);
  const Vec2 across = common::perpendicular(along);
  const auto in_axes = [&](const Vec2& x) { return Vec2(x.dot(along), x.dot(across)); };
  const HalfPlanes inside(outline);
  const double row_height = std::sqrt(0.75);
  const std::size_t boundary = result.points.size();
  for (int level = size.uniform() ? 0 : kLevels - 1; level >= 0; --level) {
    const double spacing = size.h() / (1 << level);
    const double low = level == kLevels - 1 ? 0.0 : spacing * std::sqrt(0.5);
    const double high = level == 0 ? 2 * size.h() : spacing * std::sqrt(2.0);
    Box box;
    if (level == 0) {
      for (const Vec2& vertex : outline) box.add(in_axes(vertex), 0);
    } else {
      for (const SizeField::Segment& edge : size.fine()) {
        const double reach = (high - edge.length) / edge.growth;
        if (reach <= 0) continue;
        box.add(in_axes(edge.from), reach);
        box.add(in_axes(edge.to), reach);
      }
      if (box.low.x() > box.high.x()) continue;
    }
    const auto cells = [](double x) { return static_cast<int>(std::floor(x)); };
    const int last_row = cells(box.high.y() / (row_height * spacing) - shift.y()) + 1;
    for (int row = cells(box.low.y() / (row_height * spacing) - shift.y()); row <= last_row; ++row) {
      const double offset = shift.x() + ((row & 1) != 0 ? 0.5 : 0.0);
      const int last_column = cells(box.high.x() / spacing - offset) + 1;
      for (int column = cells(box.low.x() / spacing - offset); column <= last_column; ++column) {
        const double x = (column + offset) * spacing;
        const double y = (row + shift.y()) * row_height * spacing;
        const Vec2 point = x * along + y * across;
        const double depth = inside.depth(point);
        if (depth < kClearance * kFinest * size.h()) continue;
        const double wanted = size(point);
        if (wanted < low || wanted >= high || depth < kClearance * wanted) continue;
        bool free = true;
        if (!size.uniform()) {
          for (std::size_t k = boundary; k < result.points.size() && free; ++k) {
            free = (result.points[k] - point).squaredNorm() >= kSeparation * kSeparation * wanted * wanted;
          }
        }
        if (free) result.points.push_back(point);
      }
    }
  }
  return result;
}

}  // namespace xfem
