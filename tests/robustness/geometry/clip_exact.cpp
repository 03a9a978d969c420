#include "tests/robustness/geometry/clip_exact.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <vector>

namespace differential {
namespace {

struct Point {
  mpq_class x, y;
};

bool before(const Point& p, const Point& q) {
  const int order = cmp(p.x, q.x);
  return order != 0 ? order < 0 : p.y < q.y;
}
bool same(const Point& p, const Point& q) {
  return p.x == q.x && p.y == q.y;
}

/// Twice the signed area of the triangle o, p, q.
mpq_class turn(const Point& o, const Point& p, const Point& q) {
  return (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
}

std::vector<Point> points_of(const Outline& outline) {
  std::vector<Point> points;
  for (int i = 0; i < outline.size; ++i) points.push_back({outline.x[i], outline.y[i]});
  return points;
}

/// heights[j][i] of vertex i above edge j, times the edge's length.
std::vector<std::vector<mpq_class>> heights_above(const std::vector<Point>& window, const std::vector<Point>& subject) {
  std::vector<std::vector<mpq_class>> heights;
  for (std::size_t j = 0; j < window.size(); ++j) {
    auto& row = heights.emplace_back();
    for (const Point& p : subject) row.push_back(turn(window[j], window[(j + 1) % window.size()], p));
  }
  return heights;
}

void add_vertices_inside(const std::vector<Point>& subject, const std::vector<std::vector<mpq_class>>& heights,
                         std::vector<Point>& found) {
  for (std::size_t i = 0; i < subject.size(); ++i) {
    if (std::all_of(heights.begin(), heights.end(), [i](const auto& row) { return sgn(row[i]) >= 0; })) {
      found.push_back(subject[i]);
    }
  }
}

}  // namespace

double exact_area(const OutlinePair& pair) {
  const std::vector<Point> a = points_of(pair.a);
  const std::vector<Point> b = points_of(pair.b);
  const auto above_b = heights_above(b, a);
  const auto above_a = heights_above(a, b);

  std::vector<Point> found;
  add_vertices_inside(a, above_b, found);
  add_vertices_inside(b, above_a, found);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const std::size_t i_end = (i + 1) % a.size();
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t j_end = (j + 1) % b.size();
      // Touching edges meet at vertices, which are found already, or run along each other between vertices.
      if (sgn(above_b[j][i]) * sgn(above_b[j][i_end]) >= 0 || sgn(above_a[i][j]) * sgn(above_a[i][j_end]) >= 0)
        continue;
      const mpq_class t = above_b[j][i] / (above_b[j][i] - above_b[j][i_end]);
      found.push_back({a[i].x + t * (a[i_end].x - a[i].x), a[i].y + t * (a[i_end].y - a[i].y)});
    }
  }
  std::sort(found.begin(), found.end(), before);
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  if (found.size() < 3) return 0;

  std::vector<const Point*> hull;
  const auto extend = [&hull](const Point& p, std::size_t least) {
    while (hull.size() > least && turn(*hull[hull.size() - 2], *hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(&p);
  };
  for (const Point& p : found) extend(p, 1);
  const std::size_t lower = hull.size();
  for (std::size_t k = found.size() - 1; k-- > 0;) extend(found[k], lower);

  mpq_class twice_area = 0;
  for (std::size_t k = 1; k + 2 < hull.size(); ++k) twice_area += turn(*hull[0], *hull[k], *hull[k + 1]);
  return mpq_class(twice_area / 2).get_d();
}

}  // namespace differential
