#include "xfem/crack/enrichment.hpp"

#include <algorithm>

namespace xfem {
namespace {

/// A cut from one edge of a triangle to another, seen from the node that the two edges share. Distances from that node
/// are fractions of the edges, each with its complement, so that neither loses digits when it is tiny.
struct Cut {
  int lone, next, previous;  ///< local nodes, counter-clockwise
  double s, s_rest;          ///< towards `next`
  double t, t_rest;          ///< towards `previous`
};

Cut cut_of(const Mesh& mesh, const CrackSegment& segment) {
  const auto& triangle = mesh.triangles[segment.element];
  Cut cut;
  cut.lone = 0;
  while (segment.side[(cut.lone + 1) % 3] != segment.side[(cut.lone + 2) % 3]) ++cut.lone;
  cut.next = (cut.lone + 1) % 3;
  cut.previous = (cut.lone + 2) % 3;
  const int node = triangle[cut.lone];
  const int next = triangle[cut.next];
  const bool enters_next = segment.first.edge[0] == next || segment.first.edge[1] == next;
  const CrackPoint& on_next = enters_next ? segment.first : segment.last;
  const CrackPoint& on_previous = enters_next ? segment.last : segment.first;
  cut.s = on_next.fraction;
  cut.s_rest = 1 - on_next.fraction;
  if (on_next.edge[0] != node) std::swap(cut.s, cut.s_rest);
  cut.t = on_previous.fraction;
  cut.t_rest = 1 - on_previous.fraction;
  if (on_previous.edge[0] != node) std::swap(cut.t, cut.t_rest);
  return cut;
}

Barycentric between(int from, int to, double share, double rest) {
  Barycentric place{0, 0, 0};
  place[from] = rest;
  place[to] = share;
  return place;
}

Barycentric corner(int local) {
  Barycentric place{0, 0, 0};
  place[local] = 1;
  return place;
}

/// The two parts of a triangle along one segment. Areas come from the fractions on the edges, so that they are exact
/// however small a part is.
void cut_triangle(double area, const Cut& cut, int lone_side, ShortList<ElementPart, 2>& parts) {
  const Barycentric on_next = between(cut.lone, cut.next, cut.s, cut.s_rest);
  const Barycentric on_previous = between(cut.lone, cut.previous, cut.t, cut.t_rest);
  const double alone = cut.s * cut.t * area;
  // (1 - s) + s (1 - t) = 1 - s t without cancellation.
  const double rest = (cut.s_rest + cut.s * cut.t_rest) * area;
  if (alone > 0) parts.push_back({{corner(cut.lone), on_next, on_previous}, alone, {lone_side}});
  if (rest > 0) {
    parts.push_back({{on_next, corner(cut.next), corner(cut.previous), on_previous}, rest, {-lone_side}});
  }
}

/// Cuts the convex parts further along the line of one more segment.
ShortList<ElementPart, 2> cut_parts(const ShortList<ElementPart, 2>& parts, double element_area, const Cut& cut,
                                    int lone_side) {
  // Negative on the lone node's side of the line. At the three nodes it has the topological sign, however near they
  // are.
  const auto beyond = [&](const Barycentric& p) {
    return cut.t * cut.s_rest * p[cut.next] + cut.s * cut.t_rest * p[cut.previous] - cut.s * cut.t * p[cut.lone];
  };
  ShortList<ElementPart, 2> result;
  for (const ElementPart& part : parts) {
    for (const int sign : {-1, 1}) {
      ElementPart piece;
      const std::size_t n = part.corners.size();
      for (std::size_t i = 0; i < n; ++i) {
        const Barycentric& p = part.corners[i];
        const Barycentric& q = part.corners[(i + 1) % n];
        const double dp = sign * beyond(p);
        const double dq = sign * beyond(q);
        if (dp >= 0) piece.corners.push_back(p);
        if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
          const double share = dp / (dp - dq);
          Barycentric crossing;
          for (int k = 0; k < 3; ++k) crossing[k] = p[k] + share * (q[k] - p[k]);
          piece.corners.push_back(crossing);
        }
      }
      double fraction = 0;
      for (std::size_t i = 1; i + 1 < piece.corners.size(); ++i) {
        fraction += area_fraction(piece.corners[0], piece.corners[i], piece.corners[i + 1]);
      }
      piece.area = fraction * element_area;
      if (!(piece.area > 0)) continue;
      piece.side = part.side;
      piece.side.push_back(sign < 0 ? lone_side : -lone_side);
      result.push_back(std::move(piece));
    }
  }
  return result;
}

/// Area of a node's elements, and of what lies in them on the other side of a crack.
struct Support {
  double whole = 0;
  double other_side = 0;
};

}  // namespace

Enrichment enrich(const Mesh& mesh, std::span<const Crack> cracks, double smallest_support) {
  Enrichment result;
  std::size_t points = 0;
  for (const Crack& crack : cracks) points += crack.points.size();
  result.segments.reserve(points);
  std::vector<int> cut_index(mesh.triangles.size(), -1);
  std::vector<int> elements;
  elements.reserve(points);
  for (std::size_t c = 0; c < cracks.size(); ++c) {
    const std::vector<CrackPoint>& path = cracks[c].points;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const int element = segment_element(mesh, path[i], path[i + 1]);
      result.segments.push_back(
          {static_cast<int>(c), element, segment_sides(mesh, element, path[i], path[i + 1]), path[i], path[i + 1]});
      if (cut_index[element] < 0) elements.push_back(element);
      cut_index[element] = 0;
    }
  }
  std::sort(elements.begin(), elements.end());
  result.cut.resize(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    cut_index[elements[i]] = static_cast<int>(i);
    result.cut[i].element = elements[i];
  }
  for (std::size_t i = 0; i < result.segments.size(); ++i) {
    const CrackSegment& segment = result.segments[i];
    CutElement& entry = result.cut[cut_index[segment.element]];
    const double area = mesh.areas[segment.element];
    const Cut cut = cut_of(mesh, segment);
    if (entry.segments.empty()) {
      cut_triangle(area, cut, segment.side[cut.lone], entry.parts);
    } else {
      entry.parts = cut_parts(entry.parts, area, cut, segment.side[cut.lone]);
    }
    entry.segments.push_back(static_cast<int>(i));
  }

  result.functions.reserve(points + 2 * cracks.size());
  std::vector<int> side_of_node(mesh.nodes.size(), 0);
  std::vector<int> nodes;
  std::size_t first_segment = 0;
  for (std::size_t c = 0; c < cracks.size(); ++c) {
    nodes.clear();
    std::size_t segment = first_segment;
    for (; segment < result.segments.size() && result.segments[segment].crack == static_cast<int>(c); ++segment) {
      const auto& triangle = mesh.triangles[result.segments[segment].element];
      for (int k = 0; k < 3; ++k) {
        if (side_of_node[triangle[k]] != 0) continue;
        side_of_node[triangle[k]] = result.segments[segment].side[k];
        nodes.push_back(triangle[k]);
      }
    }
    first_segment = segment;
    std::sort(nodes.begin(), nodes.end());
    std::array<int, 4> at_tip{-1, -1, -1, -1};
    for (int end = 0; end < 2 && !cracks[c].points.empty(); ++end) {
      const CrackPoint& tip = end == 0 ? cracks[c].points.front() : cracks[c].points.back();
      if (on_boundary(mesh, tip)) continue;
      at_tip[2 * end] = tip.edge[0];
      at_tip[2 * end + 1] = tip.edge[1];
    }
    for (const int node : nodes) {
      const int side = side_of_node[node];
      side_of_node[node] = 0;
      if (std::find(at_tip.begin(), at_tip.end(), node) != at_tip.end()) continue;
      Support support;
      for (int i = mesh.element_offset[node]; i < mesh.element_offset[node + 1]; ++i) {
        const int element = mesh.node_elements[i];
        support.whole += mesh.areas[element];
        if (cut_index[element] < 0) continue;
        const CutElement& entry = result.cut[cut_index[element]];
        for (std::size_t slot = 0; slot < entry.segments.size(); ++slot) {
          if (result.segments[entry.segments[slot]].crack != static_cast<int>(c)) continue;
          for (const ElementPart& part : entry.parts) {
            if (part.side[slot] != side) support.other_side += part.area;
          }
        }
      }
      if (std::min(support.other_side, support.whole - support.other_side) < smallest_support * support.whole) continue;
      const int function = static_cast<int>(result.functions.size());
      result.functions.push_back({static_cast<int>(c), node, side});
      for (int i = mesh.element_offset[node]; i < mesh.element_offset[node + 1]; ++i) {
        const int element = mesh.node_elements[i];
        if (cut_index[element] < 0) continue;
        CutElement& entry = result.cut[cut_index[element]];
        const auto& triangle = mesh.triangles[element];
        const int local = triangle[0] == node ? 0 : triangle[1] == node ? 1 : 2;
        for (std::size_t slot = 0; slot < entry.segments.size(); ++slot) {
          if (result.segments[entry.segments[slot]].crack != static_cast<int>(c)) continue;
          entry.terms.push_back({function, local, static_cast<int>(slot)});
        }
      }
    }
  }
  return result;
}

Polygon outline(const Mesh& mesh, int element, const ElementPart& part) {
  const auto& triangle = mesh.triangles[element];
  Polygon polygon;
  for (const Barycentric& p : part.corners) {
    polygon.push_back(p[0] * mesh.nodes[triangle[0]] + p[1] * mesh.nodes[triangle[1]] + p[2] * mesh.nodes[triangle[2]]);
  }
  return polygon;
}

}  // namespace xfem
