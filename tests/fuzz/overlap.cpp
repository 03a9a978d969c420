#include "common/geometry/overlap.hpp"

#include "common/geometry/center.hpp"
#include "tests/fuzz/draws.hpp"
#include "tests/robustness/geometry/check.hpp"

namespace fuzz {
namespace {

using common::Polygon;
using common::Vec2;

/// A polygon of diameter 2 about its centroid: coordinates are relative to one of the two, as the kernel asks for, and
/// sizes differ by no more than `overlap` makes them. Empty if its corners are too near to one another.
Polygon centred(Polygon polygon) {
  const double size = common::diameter(polygon);
  if (!(size > 1e-3) || !common::outline_defect(polygon).empty()) return {};
  const common::Center center = common::center_of(polygon);
  for (Vec2& v : polygon) v = 2 / size * center.to(v);
  return polygon;
}

/// Moves b so that one of its points (a vertex, or one inside an edge) comes to lie on one of a's, to within a few last
/// digits, or takes over an edge of a in reverse.
void bring_together(Draws& draws, const Polygon& a, Polygon& b) {
  const std::size_t i = draws.byte() % a.size();
  const std::size_t j = draws.byte() % b.size();
  const auto point = [](const Polygon& p, std::size_t k, double t) -> Vec2 {
    return p[k] + t * (p[(k + 1) % p.size()] - p[k]);
  };
  const int kind = draws.integer(0, 4);
  if (kind == 4) {
    const Vec2 from = a[(i + 1) % a.size()] - a[i], to = b[j] - b[(j + 1) % b.size()];
    const Vec2 turn = Vec2(from.dot(to), common::cross(to, from)) / std::sqrt(from.squaredNorm() * to.squaredNorm());
    for (Vec2& v : b) v = Vec2(turn.x() * v.x() - turn.y() * v.y(), turn.y() * v.x() + turn.x() * v.y());
  }
  const Vec2 target = point(a, i, kind & 1 ? draws.unit() : 0);
  Vec2 shift = target - point(b, j, kind & 2 ? draws.unit() : 0);
  if (draws.flag()) shift += Vec2{draws.magnitude(-56, -20), draws.magnitude(-56, -20)};
  for (Vec2& v : b) v += shift;
  if (kind == 4 && draws.flag()) {
    b[(j + 1) % b.size()] = a[i];
    b[j] = a[(i + 1) % a.size()];
  }
}

differential::Outline packed(const Polygon& polygon) {
  differential::Outline outline;
  for (const Vec2& v : polygon) outline.add(v.x(), v.y());
  outline.pad();
  return outline;
}

}  // namespace

void overlap(Input input) {
  Draws draws(input);
  Polygon a = centred(draws.polygon(12));
  Polygon b = centred(draws.polygon(12));
  if (a.empty() || b.empty()) return;
  const double ratio = draws.one_in(4) ? std::ldexp(1, -draws.integer(0, 24)) : draws.uniform(0.3, 1);
  for (Vec2& v : b) v = ratio * v;
  const Vec2 position{draws.uniform(-2, 2), draws.uniform(-2, 2)};
  for (Vec2& v : b) v += position;
  for (int moves = draws.integer(0, 2); moves > 0; --moves) bring_together(draws, a, b);
  const double scale = std::ldexp(0.25, draws.one_in(4) ? draws.integer(-20, 20) : 0);
  for (Vec2& v : a) v *= scale;
  for (Vec2& v : b) v *= scale;
  if (!common::outline_defect(a).empty() || !common::outline_defect(b).empty()) return;

  differential::Sample sample{{packed(a), packed(b)}, {}, {draws.byte()}, draws.one_in(32)};
  sample.feature = {draws.byte(), draws.byte(), draws.byte(), draws.byte()};
  differential::Tally tally;
  differential::check({&sample, 1}, common::overlap, tally);
  if (tally.disagreements == 0 && tally.oracle_failures == 0) return;
  wrong((tally.failures.empty() ? "the oracles" : tally.failures.front().what) + "\n" +
        differential::describe(sample, common::overlap));
}

}  // namespace fuzz
