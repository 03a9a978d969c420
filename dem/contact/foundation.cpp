#include "dem/contact/foundation.hpp"

#include <algorithm>
#include <cmath>

namespace dem {
namespace {

using common::Vec2;

/// The outline in chord coordinates: edges i..i+1, those before `split` b's with s ascending, then a's, descending.
struct Lens {
  int size;
  int split;
  double length;   ///< b
  bool overhangs;  ///< a boundary reaches beyond the ends of the chord
  double s[common::kMaxOverlapVertices + 1];
  double y[common::kMaxOverlapVertices + 1];
};

void transform(const common::OverlapOutline& outline, const Vec2& normal, Lens& lens) {
  lens.size = outline.size;
  lens.split = outline.first_a;
  for (int i = 0; i < outline.size; ++i) {
    lens.s[i] = normal.y() * outline.x[i] - normal.x() * outline.y[i];
    lens.y[i] = normal.x() * outline.x[i] + normal.y() * outline.y[i];
  }
  lens.y[lens.split] = 0;
  lens.s[lens.size] = lens.y[lens.size] = 0;
  lens.length = lens.s[lens.split];
  const auto beyond = [&](int i) { return lens.s[i] < 0 || lens.s[i] > lens.length; };
  lens.overhangs = beyond(1) || beyond(lens.size - 1) || beyond(lens.split - 1) || beyond(lens.split + 1);
}

/// Int of y_a y_b, and T, W_a, W_b.
struct Products {
  double ab = 0, t = 0, a = 0, b = 0;
};

/// One corner of each body, b's at (p, -g) and a's at (q, h), 0 <= p, q <= length: almost all contacts that come here.
/// Between the corners and the crossings both boundaries are straight; over such a stretch the integral of a' a b is
/// the increase of a times the mean of a b.
Products integrate_corners(double length, double p, double g, double q, double h) {
  const bool b_first = p < q;
  const bool same = p == q;  // also at an end, where the quotients are 0 / 0
  const double a_at_p = same ? h : h * (b_first ? p : length - p) / (b_first ? q : length - q);
  const double b_at_q = same ? -g : -g * (b_first ? length - q : q) / (b_first ? length - p : p);
  const double first = b_first ? p : q;
  const double last = b_first ? q : p;
  const double a1 = b_first ? a_at_p : h;
  const double b1 = b_first ? -g : b_at_q;
  const double a2 = b_first ? h : a_at_p;
  const double b2 = b_first ? b_at_q : -g;
  const double left = a1 * b1 / 3;
  const double right = a2 * b2 / 3;
  const double middle = (2 * (a1 * b1 + a2 * b2) + a1 * b2 + a2 * b1) / 6;
  return {first * left + (last - first) * middle + (length - last) * right,
          0.5 * (a1 * b1 + (b2 - b1) * (a1 + a2) - a2 * b2), a1 * left + (a2 - a1) * middle - a2 * right,
          b1 * left + (b2 - b1) * middle - b2 * right};
}

Products integrate(const Lens& lens) {
  if (lens.size == 4 && !lens.overhangs) {
    return integrate_corners(lens.length, lens.s[1], -lens.y[1], lens.s[3], lens.y[3]);
  }
  Products sum;
  for (int i = 0; i < lens.split; ++i) {
    const double run_b = lens.s[i + 1] - lens.s[i];
    if (!(run_b > 0)) continue;
    const double slope_b = (lens.y[i + 1] - lens.y[i]) / run_b;
    for (int j = lens.split; j < lens.size; ++j) {
      const double first = std::max({lens.s[i], lens.s[j + 1], 0.0});
      const double last = std::min({lens.s[i + 1], lens.s[j], lens.length});
      if (!(last > first)) continue;
      const double slope_a = (lens.y[j] - lens.y[j + 1]) / (lens.s[j] - lens.s[j + 1]);
      const double middle = 0.5 * (first + last);
      const double half = 0.5 * (last - first);
      const double ya = lens.y[j + 1] + slope_a * (middle - lens.s[j + 1]);
      const double yb = lens.y[i] + slope_b * (middle - lens.s[i]);
      const double product = 2 * half * (ya * yb + slope_a * slope_b * half * half / 3);
      sum.ab += product;
      sum.t += slope_b * 2 * half * ya;
      sum.a += slope_a * product;
      sum.b += slope_b * product;
    }
  }
  return sum;
}

/// First moment about the chord of b's side of the overlap, positive.
double moment_of_b(const Lens& lens) {
  double sum = 0;
  for (int i = 0; i < lens.split; ++i) {
    const double y0 = lens.y[i];
    const double y1 = lens.y[i + 1];
    sum += (lens.s[i + 1] - lens.s[i]) * (y0 * y0 + y0 * y1 + y1 * y1);
  }
  return sum / 6;
}

/// Area and Int s dA of what a chain's edges first..last-1 enclose with the chord's line beyond its ends.
struct Overhang {
  double area = 0, moment = 0;
};

Overhang overhang(const Lens& lens, int first, int last) {
  Overhang sum;
  for (int i = first; i < last; ++i) {
    const double s0 = lens.s[i];
    const double s1 = lens.s[i + 1];
    for (const bool left : {true, false}) {
      const double from = left ? std::min(s0, 0.0) : std::max(s0, lens.length);
      const double to = left ? std::min(s1, 0.0) : std::max(s1, lens.length);
      if (from == to) continue;
      const double slope = (lens.y[i + 1] - lens.y[i]) / (s1 - s0);
      const double y0 = lens.y[i] + slope * (from - s0);
      const double y1 = lens.y[i] + slope * (to - s0);
      sum.area -= (to - from) * (y0 + y1) / 2;
      sum.moment -= (to - from) * (from * y0 + to * y1 + (from + to) * (y0 + y1)) / 6;
    }
  }
  return sum;
}

/// Force and moment about the origin, on b.
struct Wrench {
  double t = 0, n = 0, moment = 0;
};

/// Adds what `rate` = dU/d(n . c) does at the crossing between a's edge (sa, ya) and b's edge (sb, yb).
void add_end(Wrench& wrench, double rate, double sa, double ya, double sb, double yb, double at) {
  const double sine = sa * yb - ya * sb;  // b's normal is (yb, -sb)
  if (sine == 0) return;
  const double factor = -rate * ya / sine;
  wrench.t += factor * yb;
  wrench.n -= factor * sb;
  wrench.moment -= at * factor * sb;
}

}  // namespace

NormalAction foundation_action(const common::Overlap& overlap, const common::OverlapOutline& outline,
                               double stiffness) {
  const Vec2& n = overlap.normal;
  const Vec2 t(n.y(), -n.x());
  Lens lens;
  transform(outline, n, lens);
  const int m = lens.size;
  const int k = lens.split;
  const double b = lens.length;
  const Products products = integrate(lens);
  const Vec2 to_centroid = overlap.centroid - outline.origin;
  const double s = t.dot(to_centroid);
  const double y = n.dot(to_centroid);

  // Divided by the stiffness; the part of the area law, (0, area, s area), is left out.
  Wrench more{-products.t, 0, products.b};
  const double turning = (products.a + products.b) / b;
  double rate_first = -turning;
  double rate_last = turning;
  if (lens.overhangs) {
    const Overhang of_b = overhang(lens, 0, k);
    const Overhang of_a = overhang(lens, k, m);
    more.n -= of_a.area;
    more.moment -= of_a.moment;
    const double share = (of_b.moment - of_a.moment) / b;
    rate_first += of_b.area - of_a.area - share;
    rate_last += share;
  }
  add_end(more, rate_first, lens.s[m] - lens.s[m - 1], lens.y[m] - lens.y[m - 1], lens.s[1] - lens.s[0],
          lens.y[1] - lens.y[0], 0);
  add_end(more, rate_last, lens.s[k + 1] - lens.s[k], lens.y[k + 1] - lens.y[k], lens.s[k] - lens.s[k - 1],
          lens.y[k] - lens.y[k - 1], b);

  // What is left of the moment once the force stands at the centroid.
  more.moment -= s * more.n - y * more.t;
  const double limit = 0.5 * overlap.area;
  const double lever = more.moment / b;
  const double square = std::max(more.t * more.t + more.n * more.n, lever * lever);
  if (square > limit * limit) {
    const double scale = limit / std::sqrt(square);
    more.t *= scale;
    more.n *= scale;
    more.moment *= scale;
  }

  const double ft = more.t;
  const double fn = overlap.area + more.n;
  const double size = std::sqrt(ft * ft + fn * fn);
  NormalAction action;
  action.force = stiffness * size;
  action.energy = stiffness * (2 * moment_of_b(lens) + overlap.area * y - products.ab);
  action.normal = (ft * t + fn * n) / size;
  action.point = overlap.centroid - (more.moment / size) * common::perpendicular(action.normal);
  return action;
}

}  // namespace dem
