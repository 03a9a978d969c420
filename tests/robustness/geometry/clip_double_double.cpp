#include "tests/robustness/geometry/clip_double_double.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/robustness/geometry/double_double.hpp"

namespace differential {
namespace {

using Mask = std::uint64_t;  ///< one bit for each vertex
static_assert(common::kMaxParticleVertices <= 64);

/// Relative to the sum of the magnitudes of its two products, a height is known to this; 2^-100 has room to spare.
constexpr double kRounding = 0x1p-98;
/// The same for a sum of up to 128 terms, relative to the sum of their magnitudes.
constexpr double kSumRounding = 0x1p-92;

struct Height {
  DoubleDouble value;
  double error;
};

/// cross(end - start, vertex - start) of edge `edge` of the window.
Height height(const Outline& window, int edge, const Outline& subject, int vertex) {
  const int end = window.next(edge);
  const DoubleDouble first =
      two_difference(window.x[end], window.x[edge]) * two_difference(subject.y[vertex], window.y[edge]);
  const DoubleDouble second =
      two_difference(window.y[end], window.y[edge]) * two_difference(subject.x[vertex], window.x[edge]);
  return {first - second, kRounding * (std::abs(first.high) + std::abs(second.high))};
}

/// +1, 0, -1: the sign of the height, exactly.
int sign(const Outline& window, int edge, const Outline& subject, int vertex) {
  const int end = window.next(edge);
  const double x = subject.x[vertex];
  const double y = subject.y[vertex];
  if ((x == window.x[edge] && y == window.y[edge]) || (x == window.x[end] && y == window.y[end])) return 0;
  const Height found = height(window, edge, subject, vertex);
  if (found.value.high > found.error) return 1;
  if (found.value.high < -found.error) return -1;
  return orientation(window.x[edge], window.y[edge], window.x[end], window.y[end], x, y);
}

/// On which side of every edge of the window the vertices of the subject lie.
struct Sides {
  std::array<Mask, common::kMaxParticleVertices> inner, on, outer;
  bool separated = false;  ///< an edge has no vertex on its inner side
};

Sides sides_of(const Outline& window, const Outline& subject) {
  Sides sides;
  for (int j = 0; j < window.size; ++j) {
    const int end = window.next(j);
    const double ex = window.x[end] - window.x[j];
    const double ey = window.y[end] - window.y[j];
    Mask inner = 0, on = 0, outer = 0;
    for (int i = 0; i < subject.size; ++i) {
      const double first = ex * (subject.y[i] - window.y[j]);
      const double second = ey * (subject.x[i] - window.x[j]);
      const double difference = first - second;
      const double doubt = 3.3306690738754716e-16 * (std::abs(first) + std::abs(second));  // as in orientation()
      const Mask bit = Mask{1} << i;
      if (difference > doubt) {
        inner |= bit;
      } else if (difference < -doubt) {
        outer |= bit;
      } else {
        const int side = sign(window, j, subject, i);
        (side > 0 ? inner : side < 0 ? outer : on) |= bit;
      }
    }
    sides.inner[j] = inner;
    sides.on[j] = on;
    sides.outer[j] = outer;
    sides.separated |= inner == 0;
  }
  return sides;
}

struct Sums {
  DoubleDouble twice_area, x, y;
  double twice_area_error = 0;
  double chord_error = 0;
};

struct Parameter {
  DoubleDouble value;
  double error = 0;
};

/// Where edge i of the subject crosses edge j of the window.
Parameter crossing(const Outline& window, int j, const Outline& subject, int i) {
  const Height p = height(window, j, subject, i);
  const Height q = height(window, j, subject, subject.next(i));
  const DoubleDouble span = p.value - q.value;
  return {p.value / span, 2 * (p.error + q.error) / std::abs(span.high)};
}

/// Adds the pieces of the subject's boundary inside the window. Where two edges run along each other in one direction
/// both are the boundary of the overlap; `shared_counts` says whether this one is to be counted.
void add_boundary_inside(const Outline& subject, const Outline& window, const Sides& sides, bool shared_counts,
                         Sums& sums) {
  const int n = subject.size;
  const auto at_end = [n](Mask mask) { return mask >> 1 | (mask & 1) << (n - 1); };  // bit i: vertex i + 1
  Mask excluded = 0;
  for (int j = 0; j < window.size; ++j) {
    const Mask not_inner = sides.on[j] | sides.outer[j];
    const Mask along = sides.on[j] & at_end(sides.on[j]);
    excluded |= not_inner & at_end(not_inner) & (shared_counts ? ~along : ~Mask{0});
  }
  for (int i = 0; i < n; ++i) {
    const Mask bit = Mask{1} << i;
    if (excluded & bit) continue;
    Parameter from{{0, 0}, 0}, to{{1, 0}, 0};
    for (int j = 0; j < window.size; ++j) {
      const bool enters = (sides.outer[j] & at_end(sides.inner[j]) & bit) != 0;
      const bool leaves = (sides.inner[j] & at_end(sides.outer[j]) & bit) != 0;
      if (!enters && !leaves) continue;
      const Parameter t = crossing(window, j, subject, i);
      Parameter& bound = enters ? from : to;
      if (enters ? bound.value < t.value : t.value < bound.value) bound.value = t.value;
      bound.error = std::max(bound.error, t.error);
    }
    DoubleDouble share = to.value - from.value;
    const double error = from.error + to.error + kRounding;
    if (share.high + error <= 0) continue;
    if (share.high <= 0) share = {0, 0};
    const int k = subject.next(i);
    const DoubleDouble first = two_product(subject.x[i], subject.y[k]);
    const DoubleDouble second = two_product(subject.y[i], subject.x[k]);
    const DoubleDouble moment = first - second;
    const DoubleDouble dx = two_difference(subject.x[k], subject.x[i]);
    const DoubleDouble dy = two_difference(subject.y[k], subject.y[i]);
    sums.twice_area = sums.twice_area + share * moment;
    sums.twice_area_error +=
        error * std::abs(moment.high) + kSumRounding * (std::abs(first.high) + std::abs(second.high));
    sums.x = sums.x + share * dx;
    sums.y = sums.y + share * dy;
    sums.chord_error += error * (std::abs(dx.high) + std::abs(dy.high));
  }
}

}  // namespace

DoubleDoubleClip clip_double_double(const OutlinePair& pair) {
  DoubleDoubleClip result;
  const Sides a_in_b = sides_of(pair.b, pair.a);
  const Sides b_in_a = sides_of(pair.a, pair.b);
  if (a_in_b.separated || b_in_a.separated) return result;
  Sums sums;
  add_boundary_inside(pair.a, pair.b, a_in_b, true, sums);
  result.chord = {to_double(sums.x), to_double(sums.y)};
  result.chord_error = sums.chord_error + 0x1p-52 * (std::abs(result.chord.x()) + std::abs(result.chord.y()));
  add_boundary_inside(pair.b, pair.a, b_in_a, false, sums);
  result.area = 0.5 * to_double(sums.twice_area);
  result.area_error = 0.5 * sums.twice_area_error + 0x1p-52 * std::abs(result.area);
  return result;
}

}  // namespace differential
