#include "xfem/crack/path.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/geometry/vec2.hpp"

namespace xfem {
namespace {

using common::cross;

/// Point of a boundary edge nearest to `position`, wherever on the boundary that is.
CrackPoint mouth_near(const Mesh& mesh, const Vec2& position) {
  double best = -1;
  std::array<int, 2> edge{-1, -1};
  double fraction = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbours[t][k] >= 0) continue;
      const int a = mesh.triangles[t][(k + 1) % 3];
      const int b = mesh.triangles[t][(k + 2) % 3];
      const Vec2 along = mesh.nodes[b] - mesh.nodes[a];
      const Vec2 away = position - mesh.nodes[a];
      const double s = std::clamp(away.dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double distance = (away - s * along).squaredNorm();
      if (best >= 0 && distance >= best) continue;
      best = distance;
      edge = {a, b};
      fraction = s;
    }
  }
  return point_on_edge(mesh, edge[0], edge[1], fraction);
}

/// Far more than rounding, far less than an element.
constexpr double kBeyondMouth = 1e-6;

/// Crossings of the polyline with the mesh edges, from triangle to triangle. A crossing that is undone by the next
/// one (out and back through one edge) is dropped, so that one triangle lies between two crossings.
std::vector<CrackPoint> crossings(const Mesh& mesh, std::vector<Vec2> polyline, bool mouth_first, bool mouth_last) {
  std::vector<CrackPoint> points;
  // A little beyond a last mouth, so that the line leaves the mesh by itself, also through a node of the boundary.
  const Vec2 end = polyline.back();
  const Vec2 last = end - polyline[polyline.size() - 2];
  if (mouth_last && last.squaredNorm() > 0) polyline.back() += kBeyondMouth * mesh.size / last.norm() * last;
  int triangle = -1;
  if (mouth_first) {
    points.push_back(mouth_near(mesh, polyline.front()));
    triangle = edge_elements(mesh, points.front().edge)[0];
  } else {
    triangle = mesh.locate(polyline.front());
  }
  const std::size_t limit = 4 * mesh.triangles.size() + polyline.size();
  std::size_t steps = 0;
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    const Vec2& from = polyline[i];
    const Vec2 along = polyline[i + 1] - from;
    while (++steps <= limit) {
      // Leaving through the edge whose outer side the segment reaches first.
      int exit = -1;
      double first = 1;
      for (int k = 0; k < 3; ++k) {
        const Vec2& a = mesh.nodes[mesh.triangles[triangle][(k + 1) % 3]];
        const Vec2& b = mesh.nodes[mesh.triangles[triangle][(k + 2) % 3]];
        const double outward = cross(along, b - a);
        if (outward <= 0) continue;
        const double t = cross(a - from, b - a) / outward;
        if (t < first) {
          first = t;
          exit = k;
        }
      }
      if (exit < 0) break;
      const int a = mesh.triangles[triangle][(exit + 1) % 3];
      const int b = mesh.triangles[triangle][(exit + 2) % 3];
      const Vec2 edge = mesh.nodes[b] - mesh.nodes[a];
      const double s = (from + first * along - mesh.nodes[a]).dot(edge) / edge.squaredNorm();
      const CrackPoint point = point_on_edge(mesh, a, b, s);
      const int next = mesh.neighbours[triangle][exit];
      if (!points.empty() && points.back().edge == point.edge) {
        if (next < 0) return points;
        points.pop_back();
      } else {
        points.push_back(point);
      }
      if (next < 0) return points;
      triangle = next;
    }
  }
  if (mouth_last) {
    const CrackPoint mouth = mouth_near(mesh, end);
    if (edge_elements(mesh, mouth.edge)[0] == triangle && (points.empty() || points.back().edge != mouth.edge)) {
      points.push_back(mouth);
    }
  }
  return points;
}

}  // namespace

CrackPoint point_on_edge(const Mesh& mesh, int a, int b, double fraction) {
  if (a > b) {
    std::swap(a, b);
    fraction = 1 - fraction;
  }
  fraction = std::clamp(fraction, kEdgeClearance, 1 - kEdgeClearance);
  return {{a, b}, fraction, mesh.nodes[a] + fraction * (mesh.nodes[b] - mesh.nodes[a])};
}

std::array<int, 2> edge_elements(const Mesh& mesh, const std::array<int, 2>& edge) {
  std::array<int, 2> found{-1, -1};
  const int nodes = static_cast<int>(mesh.nodes.size());
  if (edge[0] < 0 || edge[1] < 0 || edge[0] >= nodes || edge[1] >= nodes) return found;
  int count = 0;
  for (int i = mesh.element_offset[edge[0]]; i < mesh.element_offset[edge[0] + 1] && count < 2; ++i) {
    const int t = mesh.node_elements[i];
    if (mesh.local_edge(t, edge[0], edge[1]) >= 0) found[count++] = t;
  }
  if (count == 2 && found[0] > found[1]) std::swap(found[0], found[1]);
  return found;
}

bool on_boundary(const Mesh& mesh, const CrackPoint& point) {
  return edge_elements(mesh, point.edge)[1] < 0;
}

int segment_element(const Mesh& mesh, const CrackPoint& first, const CrackPoint& last) {
  if (first.edge == last.edge) return -1;
  for (const int t : edge_elements(mesh, first.edge)) {
    if (t >= 0 && mesh.local_edge(t, last.edge[0], last.edge[1]) >= 0) return t;
  }
  return -1;
}

std::array<int, 3> segment_sides(const Mesh& mesh, int element, const CrackPoint& first, const CrackPoint& last) {
  // An edge lies opposite to its local node, so the node that the two edges share is the third one.
  const int entry = mesh.local_edge(element, first.edge[0], first.edge[1]);
  const int exit = mesh.local_edge(element, last.edge[0], last.edge[1]);
  const int lone = 3 - entry - exit;
  // Counter-clockwise (lone, next, previous): entering between lone and next keeps the lone node on the left.
  const int side = entry == (lone + 2) % 3 ? 1 : -1;
  std::array<int, 3> sides{-side, -side, -side};
  sides[lone] = side;
  return sides;
}

std::string crack_defect(const Mesh& mesh, const Crack& crack) {
  if (crack.points.size() < 2) return "a crack needs at least 2 points";
  std::map<int, int> side_of_node;
  std::set<int> cut;
  for (std::size_t i = 0; i < crack.points.size(); ++i) {
    const CrackPoint& point = crack.points[i];
    const std::string name = "crack point " + std::to_string(i);
    if (edge_elements(mesh, point.edge)[0] < 0) return name + " names an edge that the mesh does not have";
    if (!(point.fraction > 0 && point.fraction < 1)) return name + " does not lie inside its edge";
    if (i == 0) continue;
    if (i + 1 < crack.points.size() && on_boundary(mesh, point))
      return name + " is inside the crack but on the boundary";
    const int element = segment_element(mesh, crack.points[i - 1], point);
    if (element < 0) return name + " and the point before it have no element in common";
    if (!cut.insert(element).second) return name + " cuts an element for the second time";
    const std::array<int, 3> sides = segment_sides(mesh, element, crack.points[i - 1], point);
    for (int k = 0; k < 3; ++k) {
      const auto [entry, is_new] = side_of_node.emplace(mesh.triangles[element][k], sides[k]);
      if (!is_new && entry->second != sides[k]) return name + " puts a node on both sides of the crack";
    }
  }
  return {};
}

Crack place_polyline(const Mesh& mesh, std::span<const Vec2> polyline, std::array<TipState, 2> tips) {
  Crack crack;
  crack.tips = tips;
  if (polyline.size() < 2) return crack;
  const std::vector<CrackPoint> found = crossings(mesh, {polyline.begin(), polyline.end()},
                                                  tips[0] == TipState::at_boundary, tips[1] == TipState::at_boundary);
  // The longest beginning that is a crack.
  for (const CrackPoint& point : found) {
    crack.points.push_back(point);
    if (crack.points.size() < 2 || crack_defect(mesh, crack).empty()) continue;
    crack.points.pop_back();
    break;
  }
  if (crack.points.size() < 2) {
    crack.points.clear();
    return crack;
  }
  const std::array<const CrackPoint*, 2> ends{&crack.points.front(), &crack.points.back()};
  for (int end = 0; end < 2; ++end) {
    if (on_boundary(mesh, *ends[end])) {
      crack.tips[end] = TipState::at_boundary;
    } else if (crack.tips[end] == TipState::at_boundary) {
      crack.tips[end] = TipState::active;
    }
  }
  return crack;
}

}  // namespace xfem
