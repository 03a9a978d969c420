#include "tests/robustness/geometry/clip_exact.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>
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

Point point(const Outline& outline, int i) {
  return {outline.x[i], outline.y[i]};
}

using Signs = std::array<std::array<signed char, common::kMaxParticleVertices>, common::kMaxParticleVertices>;

/// signs[j][i]: side of edge j of the window on which vertex i lies.
void sides_of(const Outline& window, const Outline& subject, Signs& signs) {
  for (int j = 0; j < window.size; ++j) {
    const int end = window.next(j);
    for (int i = 0; i < subject.size; ++i) {
      signs[j][i] = static_cast<signed char>(
          orientation(window.x[j], window.y[j], window.x[end], window.y[end], subject.x[i], subject.y[i]));
    }
  }
}

void add_vertices_inside(const Outline& subject, const Outline& window, const Signs& signs, std::vector<Point>& found) {
  for (int i = 0; i < subject.size; ++i) {
    if (std::all_of(signs.begin(), signs.begin() + window.size, [i](const auto& row) { return row[i] >= 0; })) {
      found.push_back(point(subject, i));
    }
  }
}

/// Where edge i of a crosses edge j of b.
Point crossing(const Outline& a, int i, const Outline& b, int j) {
  const Point p = point(a, i), q = point(a, a.next(i)), v = point(b, j), w = point(b, b.next(j));
  const mpq_class height = turn(v, w, p);
  const mpq_class t = height / (height - turn(v, w, q));
  return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

}  // namespace

double exact_area(const OutlinePair& pair) {
  const auto& [a, b] = pair;
  Signs above_b, above_a;
  sides_of(b, a, above_b);
  sides_of(a, b, above_a);

  std::vector<Point> found;
  add_vertices_inside(a, b, above_b, found);
  add_vertices_inside(b, a, above_a, found);
  for (int i = 0; i < a.size; ++i) {
    for (int j = 0; j < b.size; ++j) {
      // Touching edges meet at vertices, which are found already, or run along each other between vertices.
      if (above_b[j][i] * above_b[j][a.next(i)] < 0 && above_a[i][j] * above_a[i][b.next(j)] < 0) {
        found.push_back(crossing(a, i, b, j));
      }
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
