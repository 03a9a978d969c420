#include "xfem/crack/enrichment.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "common/geometry/vec2.hpp"

namespace xfem {
namespace {

using common::cross;

/// The two parts of a triangle along one segment. Areas come from the fractions on the edges, not from coordinates,
/// so that they are exact however small a part is.
std::vector<ElementPart> cut_triangle(const Mesh& mesh, const CrackSegment& segment) {
  const auto& triangle = mesh.triangles[segment.element];
  int lone = 0;
  while (segment.side[(lone + 1) % 3] != segment.side[(lone + 2) % 3]) ++lone;
  const int node = triangle[lone];
  const int next = triangle[(lone + 1) % 3];
  const int previous = triangle[(lone + 2) % 3];
  const auto from_lone = [&](const CrackPoint& p) { return p.edge[0] == node ? p.fraction : 1 - p.fraction; };
  const bool enters_next = segment.first.edge[0] == next || segment.first.edge[1] == next;
  const CrackPoint& on_next = enters_next ? segment.first : segment.last;
  const CrackPoint& on_previous = enters_next ? segment.last : segment.first;
  const double s = from_lone(on_next);
  const double t = from_lone(on_previous);
  const double area = mesh.areas[segment.element];
  std::vector<ElementPart> parts;
  const double corner = s * t * area;
  // (1 - s) + s (1 - t) = 1 - s t without cancellation.
  const double rest = ((1 - s) + s * (1 - t)) * area;
  const int side = segment.side[lone];
  if (corner > 0) {
    parts.push_back({{mesh.nodes[node], on_next.position, on_previous.position}, corner, {side}});
  }
  if (rest > 0) {
    parts.push_back({{on_next.position, mesh.nodes[next], mesh.nodes[previous], on_previous.position}, rest, {-side}});
  }
  return parts;
}

/// Cuts the convex parts further along the line of one more segment.
std::vector<ElementPart> cut_parts(const std::vector<ElementPart>& parts, const CrackSegment& segment) {
  const Vec2& origin = segment.first.position;
  const Vec2 along = segment.last.position - origin;
  std::vector<ElementPart> result;
  for (const ElementPart& part : parts) {
    for (const int side : {1, -1}) {
      Polygon piece;
      const std::size_t n = part.outline.size();
      for (std::size_t i = 0; i < n; ++i) {
        const Vec2& p = part.outline[i];
        const Vec2& q = part.outline[(i + 1) % n];
        const double dp = side * cross(along, p - origin);
        const double dq = side * cross(along, q - origin);
        if (dp >= 0) piece.push_back(p);
        if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) piece.push_back(p + dp / (dp - dq) * (q - p));
      }
      if (piece.size() < 3) continue;
      const double area = common::area(piece);
      if (area <= 0) continue;
      std::vector<int> sides = part.side;
      sides.push_back(side);
      result.push_back({std::move(piece), area, std::move(sides)});
    }
  }
  return result;
}

}  // namespace

Enrichment enrich(const Mesh& mesh, std::span<const Crack> cracks) {
  Enrichment result;
  std::map<int, CutElement> cut;
  std::vector<std::map<int, int>> side_of_node(cracks.size());
  for (std::size_t c = 0; c < cracks.size(); ++c) {
    const std::vector<CrackPoint>& points = cracks[c].points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const int element = segment_element(mesh, points[i], points[i + 1]);
      const CrackSegment segment{static_cast<int>(c), element, segment_sides(mesh, element, points[i], points[i + 1]),
                                 points[i], points[i + 1]};
      for (int k = 0; k < 3; ++k) side_of_node[c].emplace(mesh.triangles[element][k], segment.side[k]);
      CutElement& entry = cut[element];
      entry.element = element;
      entry.parts = entry.segments.empty() ? cut_triangle(mesh, segment) : cut_parts(entry.parts, segment);
      entry.segments.push_back(static_cast<int>(result.segments.size()));
      result.segments.push_back(segment);
    }
  }

  for (std::size_t c = 0; c < cracks.size(); ++c) {
    std::set<int> at_tip;
    for (const CrackPoint* end : {&cracks[c].points.front(), &cracks[c].points.back()}) {
      if (!on_boundary(mesh, *end)) at_tip.insert(end->edge.begin(), end->edge.end());
    }
    for (const auto& [node, side] : side_of_node[c]) {
      if (at_tip.contains(node)) continue;
      double support = 0;
      double other_side = 0;
      for (int i = mesh.element_offset[node]; i < mesh.element_offset[node + 1]; ++i) {
        const int element = mesh.node_elements[i];
        support += mesh.areas[element];
        const auto entry = cut.find(element);
        if (entry == cut.end()) continue;
        for (std::size_t slot = 0; slot < entry->second.segments.size(); ++slot) {
          if (result.segments[entry->second.segments[slot]].crack != static_cast<int>(c)) continue;
          for (const ElementPart& part : entry->second.parts) {
            if (part.side[slot] != side) other_side += part.area;
          }
        }
      }
      if (std::min(other_side, support - other_side) < kSmallestSupport * support) continue;
      const int function = static_cast<int>(result.functions.size());
      result.functions.push_back({static_cast<int>(c), node, side});
      for (int i = mesh.element_offset[node]; i < mesh.element_offset[node + 1]; ++i) {
        const auto entry = cut.find(mesh.node_elements[i]);
        if (entry == cut.end()) continue;
        const auto& triangle = mesh.triangles[entry->first];
        const int local = triangle[0] == node ? 0 : triangle[1] == node ? 1 : 2;
        for (std::size_t slot = 0; slot < entry->second.segments.size(); ++slot) {
          if (result.segments[entry->second.segments[slot]].crack != static_cast<int>(c)) continue;
          entry->second.terms.push_back({function, local, static_cast<int>(slot)});
        }
      }
    }
  }
  for (auto& [element, entry] : cut) result.cut.push_back(std::move(entry));
  return result;
}

}  // namespace xfem
