// Polygon a is clipped by the half-planes of b one after the other (I. E. Sutherland and G. W. Hodgman, Reentrant
// polygon clipping, CACM 17, 1974), every edge remembering whose boundary it is a piece of. The half-plane that
// separates best comes first: it leaves little of a, so that the others are cheap, and it rejects most near misses.
#include "common/geometry/clip_overlap.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace common {
namespace {

/// A chord shorter than this fraction of sqrt(area) is rounding: it has no direction.
constexpr double kNoChord = 1e-12;

struct Point {
  double x;
  double y;
};

/// A convex polygon; edge i goes from vertex i to the next one.
struct Outline {
  int size;
  Point vertex[kMaxOverlapVertices];
  bool from_b[kMaxOverlapVertices];  ///< edge i is a piece of b's boundary, not of a's
};

/// A directed line; `height` is positive on its left, times the length of the edge.
struct Line {
  Point start;
  Point direction;
  double height(const Point& p) const { return direction.x * (p.y - start.y) - direction.y * (p.x - start.x); }
};

/// Edge i of a polygon of n vertices. Its end has height exactly zero, so that an edge shared bit for bit is not cut.
Line edge_line(const Point* vertex, int n, int i) {
  const Point& p = vertex[i];
  const Point& q = vertex[i + 1 < n ? i + 1 : 0];
  return {p, {q.x - p.x, q.y - p.y}};
}

/// Writes the polygon relative to `origin`; returns the mean of its vertices.
Point shift(const OutlineView& polygon, const Vec2& origin, Point* vertex) {
  Point sum{0, 0};
  for (int i = 0; i < polygon.size; ++i) {
    vertex[i] = {polygon.x[i] - origin.x(), polygon.y[i] - origin.y()};
    sum.x += vertex[i].x;
    sum.y += vertex[i].y;
  }
  const double scale = 1.0 / polygon.size;
  return {sum.x * scale, sum.y * scale};
}

/// The edge that has `point` furthest on its outer side, long edges preferred.
int facing_edge(const Point* vertex, int n, const Point& point) {
  int best = 0;
  double lowest = edge_line(vertex, n, 0).height(point);
  for (int i = 1; i < n; ++i) {
    const double height = edge_line(vertex, n, i).height(point);
    best = height < lowest ? i : best;
    lowest = height < lowest ? height : lowest;
  }
  return best;
}

bool separates(const Line& line, const Point* vertex, int n) {
  double highest = line.height(vertex[0]);
  for (int i = 1; i < n; ++i) {
    const double height = line.height(vertex[i]);
    highest = height > highest ? height : highest;
  }
  return highest <= 0;
}

/// The point between p and q where the height, of opposite signs there, is zero.
Point crossing(const Point& p, double height_p, const Point& q, double height_q) {
  const double t = height_p / (height_p - height_q);
  return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

enum class Cut { none, partial, all };

/// Writes to `to` what of `from` is left of the line, an edge of b. The kept vertices are taken as one chain around
/// the highest vertex, so that at most one new edge arises whatever the rounding, and vertices never multiply.
Cut clip(const Outline& from, const Line& line, Outline& to) {
  const int n = from.size;
  double height[kMaxOverlapVertices];
  int top = 0;
  double highest = height[0] = line.height(from.vertex[0]);
  double lowest = highest;
  for (int i = 1; i < n; ++i) {
    const double h = height[i] = line.height(from.vertex[i]);
    top = h > highest ? i : top;
    highest = h > highest ? h : highest;
    lowest = h < lowest ? h : lowest;
  }
  if (!(highest > 0)) return Cut::all;
  if (lowest >= 0) return Cut::none;
  const auto next = [n](int i) { return i + 1 < n ? i + 1 : 0; };
  const auto previous = [n](int i) { return i > 0 ? i - 1 : n - 1; };
  int first = top;
  int before = previous(first);
  while (height[before] >= 0) {
    first = before;
    before = previous(first);
  }
  int last = top;
  int after = next(last);
  while (height[after] >= 0) {
    last = after;
    after = next(last);
  }
  int m = 0;
  const auto add = [&](const Point& p, bool from_b) {
    to.vertex[m] = p;
    to.from_b[m] = from_b;
    ++m;
  };
  if (height[first] > 0) {
    add(crossing(from.vertex[before], height[before], from.vertex[first], height[first]), from.from_b[before]);
  }
  for (int i = first; i != last; i = next(i)) add(from.vertex[i], from.from_b[i]);
  if (height[last] > 0) {
    add(from.vertex[last], from.from_b[last]);
    add(crossing(from.vertex[last], height[last], from.vertex[after], height[after]), true);
  } else {
    add(from.vertex[last], true);
  }
  to.size = m;
  return Cut::partial;
}

/// Area and centroid of the overlap polygon, relative to its first vertex.
void measure(const Outline& outline, const Vec2& origin, Overlap& result) {
  const Point base = outline.vertex[0];
  double sum = 0;
  double magnitude = 0;
  Point first{0, 0};
  Point p{outline.vertex[1].x - base.x, outline.vertex[1].y - base.y};
  for (int i = 2; i < outline.size; ++i) {
    const Point q{outline.vertex[i].x - base.x, outline.vertex[i].y - base.y};
    const double weight = p.x * q.y - p.y * q.x;
    sum += weight;
    magnitude += std::abs(weight);
    first.x += weight * (p.x + q.x);
    first.y += weight * (p.y + q.y);
    p = q;
  }
  if (!(sum > 0)) return;
  result.area = 0.5 * sum;
  if (magnitude <= 1.5 * sum) {
    const double scale = 1 / (3 * sum);
    result.centroid = {origin.x() + (base.x + first.x * scale), origin.y() + (base.y + first.y * scale)};
    return;
  }
  // A sliver as thin as rounding, whose triangles cancel: the mean of its vertices is inside.
  Point mean{0, 0};
  for (int i = 0; i < outline.size; ++i) {
    mean.x += outline.vertex[i].x;
    mean.y += outline.vertex[i].y;
  }
  result.centroid = {origin.x() + mean.x / outline.size, origin.y() + mean.y / outline.size};
}

Vec2 centroid_of(const OutlineView& polygon) {
  Vec2 vertex[kMaxOverlapVertices];
  for (int i = 0; i < polygon.size; ++i) vertex[i] = polygon[i];
  return centroid({vertex, static_cast<std::size_t>(polygon.size)});
}

/// Crossings, normal and width from the vertices at which the boundary passes from one polygon to the other.
void find_chord(const Outline& outline, const Vec2& origin, const OutlineView& a, const OutlineView& b,
                Overlap& result) {
  Point chord{0, 0};  // sum over the pieces of a's boundary of end minus start
  Point sum{0, 0};
  bool previous = outline.from_b[outline.size - 1];
  for (int i = 0; i < outline.size; ++i) {
    if (outline.from_b[i] != previous) {
      const Point& p = outline.vertex[i];
      const double sign = previous ? -1 : 1;
      chord.x += sign * p.x;
      chord.y += sign * p.y;
      sum.x += p.x;
      sum.y += p.y;
      ++result.crossings;
      previous = outline.from_b[i];
    }
  }
  const double root = std::sqrt(result.area);
  const double length = std::sqrt(chord.x * chord.x + chord.y * chord.y);
  const bool has_chord = length > kNoChord * root;
  if (!has_chord && result.crossings == 2) result.crossings = 0;  // one polygon inside, a vertex on the boundary
  if (has_chord) {
    result.normal = {chord.y / length, -chord.x / length};
  } else {
    const Vec2 axis = centroid_of(b) - centroid_of(a);
    const double distance = axis.norm();
    result.normal = distance > kNoChord * root ? Vec2(axis / distance) : Vec2(1, 0);
  }
  result.width = std::max(length, root);
  if (result.crossings > 0) {
    result.chord_midpoint = {origin.x() + sum.x / result.crossings, origin.y() + sum.y / result.crossings};
  } else {
    result.chord_midpoint = result.centroid;
  }
}

/// The outline of an overlap with two crossings, if both polygons have corners on it.
void write(const Outline& outline, const Vec2& origin, OverlapOutline& result) {
  const int n = outline.size;
  const auto of_b = static_cast<int>(std::count(outline.from_b, outline.from_b + n, true));
  if (of_b == 1 || of_b == n - 1) return;
  int start = 0;
  while (!outline.from_b[start] || outline.from_b[start > 0 ? start - 1 : n - 1]) ++start;
  const Point base = outline.vertex[start];
  result.size = n;
  result.first_a = of_b;
  result.origin = {origin.x() + base.x, origin.y() + base.y};
  for (int k = 0, i = start; k < n; ++k, i = i + 1 < n ? i + 1 : 0) {
    result.x[k] = outline.vertex[i].x - base.x;
    result.y[k] = outline.vertex[i].y - base.y;
  }
}

}  // namespace

Overlap clip_overlap(const OutlineView& a, const OutlineView& b, OverlapOutline* outline) {
  assert(a.size >= 3 && b.size >= 3 && a.size + b.size <= kMaxOverlapVertices);
  Overlap result;
  if (outline) outline->size = 0;
  const Vec2 origin = a[0];
  Outline buffers[2];
  Outline* from = &buffers[0];
  Outline* to = &buffers[1];
  Point window[kMaxOverlapVertices];
  const Point middle_a = shift(a, origin, from->vertex);
  const Point middle_b = shift(b, origin, window);

  const int facing_b = facing_edge(window, b.size, middle_a);
  if (separates(edge_line(window, b.size, facing_b), from->vertex, a.size)) return result;
  const int facing_a = facing_edge(from->vertex, a.size, middle_b);
  if (separates(edge_line(from->vertex, a.size, facing_a), window, b.size)) return result;

  from->size = a.size;
  std::fill_n(from->from_b, a.size, false);
  for (int k = 0, i = facing_b; k < b.size; ++k, i = i + 1 < b.size ? i + 1 : 0) {
    const Cut cut = clip(*from, edge_line(window, b.size, i), *to);
    if (cut == Cut::all) return result;
    if (cut == Cut::partial) std::swap(from, to);
  }
  measure(*from, origin, result);
  if (result.area > 0) find_chord(*from, origin, a, b, result);
  if (outline && result.crossings == 2) write(*from, origin, *outline);
  return result;
}

}  // namespace common
