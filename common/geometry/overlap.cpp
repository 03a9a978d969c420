// Most pairs of a packing either have an edge between them, the same one for many steps, or cross twice. So: test the
// remembered edge; else follow the boundaries from it to the two crossings and prove the outline that they bound. The
// proof: the vertices of either polygon on that outline lie inside the other polygon, and both crossings are proper.
// By convexity nothing else can be the overlap, wherever the search started. Everything else is clipped.
#include "common/geometry/overlap.hpp"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/geometry/clip_overlap.hpp"

namespace common {
namespace {

/// Doubles side by side; each lane has the bits that scalar code would give.
#ifdef __AVX__
constexpr int kLanes = 4;
#else
constexpr int kLanes = 2;
#endif
using Two = double __attribute__((vector_size(2 * sizeof(double))));
using Wide = double __attribute__((vector_size(kLanes * sizeof(double))));
using Masks = long long __attribute__((vector_size(kLanes * sizeof(double))));
using Set = std::uint64_t;  ///< of vertices

constexpr int kMaxFast = 64;
constexpr double kNoChord = 1e-12;

inline const Wide& wide(const double* p) {
  return *reinterpret_cast<const Wide*>(p);
}

/// Bit i: lane i is negative (or -0, or not a number: what follows does not mind).
template <class Vector>
inline unsigned signs(const Vector& v) {
#ifdef __AVX__
  if constexpr (sizeof(v) == 32) return static_cast<unsigned>(__builtin_ia32_movmskpd256(v));
#endif
#ifdef __SSE2__
  if constexpr (sizeof(v) == 16) return static_cast<unsigned>(__builtin_ia32_movmskpd(v));
#endif
  unsigned set = 0;
  for (unsigned i = 0; i < sizeof(v) / sizeof(double); ++i) set |= static_cast<unsigned>(v[i] < 0) << i;
  return set;
}

/// Number of entries of an outline: known if kPadded is not 0.
template <int kPadded>
[[gnu::always_inline]] inline int padded(const OutlineView& p) {
  return kPadded > 0 ? kPadded : p.padded;
}

inline Set all(int size) {
  return ~Set{0} >> (64 - size);
}

struct Line {
  double x, y, dx, dy;
  double height(double px, double py) const { return dx * (py - y) - dy * (px - x); }
};

inline int next(const OutlineView& p, int i) {
  return i + 1 < p.size ? i + 1 : 0;
}
inline int previous(const OutlineView& p, int i) {
  return i > 0 ? i - 1 : p.size - 1;
}
inline Line edge_line(const OutlineView& p, int i) {
  const int j = next(p, i);
  return {p.x[i], p.y[i], p.x[j] - p.x[i], p.y[j] - p.y[i]};
}

/// The vertices on the inner side of a line, those of the padding included.
template <int kPadded>
[[gnu::always_inline]] inline Set above(const OutlineView& p, const Line& line) {
  Set set = 0;
  for (int i = 0; i < padded<kPadded>(p); i += kLanes) {
    const Wide depth = line.dy * (wide(p.x + i) - line.x) - line.dx * (wide(p.y + i) - line.y);
    set |= Set{signs(depth)} << i;
  }
  return set;
}

/// The vertices i+1, ... that follow those from i on; the first one follows the last one.
[[gnu::always_inline]] inline Wide successors(const double* p, int i, int padded) {
  const int j = i + kLanes < padded ? i + kLanes : 0;
#ifdef __AVX__
  return __builtin_shufflevector(wide(p + i), wide(p + j), 1, 2, 3, 4);
#else
  return __builtin_shufflevector(wide(p + i), wide(p + j), 1, 2);
#endif
}

/// True if no edge has the point on its outer side. The padding makes edges of length 0, that have height 0.
template <int kPadded>
[[gnu::always_inline]] inline bool inside(const OutlineView& p, double x, double y) {
  Masks outside{};
  for (int i = 0; i < padded<kPadded>(p); i += kLanes) {
    const Wide& px = wide(p.x + i);
    const Wide& py = wide(p.y + i);
    const Wide dx = successors(p.x, i, padded<kPadded>(p)) - px;
    const Wide dy = successors(p.y, i, padded<kPadded>(p)) - py;
    outside |= dx * (y - py) < dy * (x - px);
  }
  return signs(Wide(outside)) == 0;
}

/// Vertices `first` to `last` of an outline.
struct Run {
  int first;
  int last;
};

/// A set that is one run around an outline of n vertices; first = -1 if it is not.
inline Run run_of(Set set, int n) {
  if ((set & (set - 1)) == 0) {
    const int i = std::countr_zero(set);
    return {set != 0 ? i : -1, i};
  }
  const Set turned = ((set << 1) | (set >> (n - 1))) & all(n);
  const Set starts = set & ~turned;
  if (starts == 0 || (starts & (starts - 1)) != 0) return {-1, -1};
  const Set ends = set & ~((set >> 1) | (set << (n - 1)));
  return {std::countr_zero(starts), std::countr_zero(ends)};
}

/// The triangles between the first crossing (x, y) and the sides of the overlap, one after the other; vertices and
/// crossings relative to a near origin.
class Fan {
 public:
  Fan(double x, double y, double first_x, double first_y) : x_(x), y_(y), ux_(first_x - x), uy_(first_y - y) {}

  void add(double vertex_x, double vertex_y) {
    const double vx = vertex_x - x_;
    const double vy = vertex_y - y_;
    const double weight = ux_ * vy - uy_ * vx;
    convex_ = convex_ & (weight > 0);
    sum_ += weight;
    moment_x_ += weight * (ux_ + vx);
    moment_y_ += weight * (uy_ + vy);
    ux_ = vx;
    uy_ = vy;
  }

  /// False, and nothing is set, if a triangle is turned over: then rounding has put a crossing beyond a vertex.
  /// sign: 1 if the second crossing lies ahead along b's boundary.
  bool measure(const Line& origin, double second_x, double second_y, double sign, Overlap& result) const {
    const double cx = second_x - x_;
    const double cy = second_y - y_;
    const double area = 0.5 * sum_;
    const double square = cx * cx + cy * cy;
    if (!convex_ || !(square > kNoChord * kNoChord * area)) return false;
    const double length = std::sqrt(square);
    const double third = 1 / (3 * sum_);
    const double unit = sign / length;
    result.area = area;
    result.width = square > area ? length : std::sqrt(area);
    result.normal = {-cy * unit, cx * unit};
    result.centroid = {origin.x + (x_ + moment_x_ * third), origin.y + (y_ + moment_y_ * third)};
    result.chord_midpoint = {origin.x + (x_ + 0.5 * cx), origin.y + (y_ + 0.5 * cy)};
    result.crossings = 2;
    return true;
  }

 private:
  double x_, y_;
  double ux_, uy_;
  double sum_ = 0, moment_x_ = 0, moment_y_ = 0;
  bool convex_ = true;
};

/// The overlap of p and q if q enters and leaves p through edge e, and all its vertices inside that edge, `seen`, are
/// inside p. sign: 1 if p is a, -1 if it is b.
template <int kPadded>
[[gnu::always_inline]] inline bool poke(const OutlineView& p, const OutlineView& q, int e, const Line& edge, Set seen,
                                        double sign, Overlap& result) {
  const auto [k, l] = run_of(seen, q.size);
  if (k < 0) return false;
  const int before = previous(q, k);
  const int after = next(q, l);
  const int end = next(p, e);
  // Heights of the edge's ends over q's edges: entering and leaving side by side.
  const Two x{q.x[before], q.x[l]};
  const Two y{q.y[before], q.y[l]};
  const Two dx = Two{q.x[k], q.x[after]} - x;
  const Two dy = Two{q.y[k], q.y[after]} - y;
  const Two from = dx * (edge.y - y) - dy * (edge.x - x);
  const Two to = dx * (p.y[end] - y) - dy * (p.x[end] - x);
  if (signs(from) != 2 || signs(to) != 1) return false;
  for (int i = k;; i = next(q, i)) {
    if (!inside<kPadded>(p, q.x[i], q.y[i])) return false;
    if (i == l) break;
  }
  const Two t = from / (from - to);
  const Two cx = t * edge.dx;
  const Two cy = t * edge.dy;
  const Two along = (cx - (x - edge.x)) * dx + (cy - (y - edge.y)) * dy;
  const Two ahead = dx * dx + dy * dy - along;
  if ((signs(along) | signs(ahead)) != 0) return false;
  Fan fan(cx[0], cy[0], q.x[k] - edge.x, q.y[k] - edge.y);
  for (int i = k; i != l;) {
    i = next(q, i);
    fan.add(q.x[i] - edge.x, q.y[i] - edge.y);
  }
  fan.add(cx[1], cy[1]);
  return fan.measure(edge, cx[1], cy[1], sign, result);
}

/// True if the point, relative to `origin`, lies between the ends of an edge. Nearly parallel edges cross at an
/// uncertain place, which may be beyond.
inline bool within(const Line& edge, const Line& origin, double x, double y) {
  const double along = (x - (edge.x - origin.x)) * edge.dx + (y - (edge.y - origin.y)) * edge.dy;
  return along >= 0 && along <= edge.dx * edge.dx + edge.dy * edge.dy;
}

/// Adds vertices to an outline, relative to its first one.
class OutlineWriter {
 public:
  /// `origin` and, relative to it, the first vertex.
  OutlineWriter(OverlapOutline& outline, const Vec2& origin, const Vec2& first) : outline_(outline), first_(first) {
    outline.origin = origin + first;
    outline.x[0] = outline.y[0] = 0;
    outline.size = 1;
  }
  void add(double x, double y) {
    outline_.x[outline_.size] = x - first_.x();
    outline_.y[outline_.size] = y - first_.y();
    ++outline_.size;
  }

 private:
  OverlapOutline& outline_;
  Vec2 first_;
};

/// What `follow` found; the edges of p at the crossings.
struct Found {
  int entry = -1;  ///< -1: not two plain crossings
  int exit = -1;
};

/// The overlap of p and q if it is bounded by two proper crossings, `seen` being q's vertices inside edge e of p.
template <int kPadded>
Found follow(const OutlineView& p, const OutlineView& q, int e, Set seen, double sign, Overlap& result,
             OverlapOutline* outline) {
  Set in = 0;
  for (Set rest = seen; rest; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    if (inside<kPadded>(p, q.x[i], q.y[i])) in |= Set{1} << i;
  }
  const auto [k, l] = run_of(in, q.size);
  if (k < 0) return {};

  // q's boundary enters p across edge j1 ...
  const int before = previous(q, k);
  const Line entering = edge_line(q, before);
  int j1 = e;
  double from1, to1;
  for (int move = 0;; ++move) {
    const int n = next(p, j1);
    from1 = entering.height(p.x[j1], p.y[j1]);
    to1 = entering.height(p.x[n], p.y[n]);
    if (from1 > 0 && to1 < 0) break;
    if (move == p.size) return {};
    j1 = to1 < 0 ? previous(p, j1) : n;
  }
  const Line edge1 = edge_line(p, j1);
  if (edge1.height(q.x[before], q.y[before]) > 0) return {};
  // ... and leaves it across edge j2
  const int after = next(q, l);
  const Line leaving = edge_line(q, l);
  int j2 = e;
  double from2, to2;
  for (int move = 0;; ++move) {
    const int n = next(p, j2);
    from2 = leaving.height(p.x[j2], p.y[j2]);
    to2 = leaving.height(p.x[n], p.y[n]);
    if (from2 < 0 && to2 > 0) break;
    if (move == p.size) return {};
    j2 = to2 > 0 ? previous(p, j2) : n;
  }
  const Line edge2 = edge_line(p, j2);
  if (edge2.height(q.x[after], q.y[after]) > 0) return {};

  const double t1 = from1 / (from1 - to1);
  const double t2 = from2 / (from2 - to2);
  const double x1 = t1 * edge1.dx;
  const double y1 = t1 * edge1.dy;
  const double x2 = (edge2.x - edge1.x) + t2 * edge2.dx;
  const double y2 = (edge2.y - edge1.y) + t2 * edge2.dy;
  if (!within(entering, edge1, x1, y1) || !within(leaving, edge1, x2, y2)) return {};
  Fan fan(x1, y1, q.x[k] - edge1.x, q.y[k] - edge1.y);
  for (int i = k; i != l;) {
    i = next(q, i);
    fan.add(q.x[i] - edge1.x, q.y[i] - edge1.y);
  }
  fan.add(x2, y2);
  for (int i = j2; i != j1;) {
    i = next(p, i);
    if (!inside<kPadded>(q, p.x[i], p.y[i])) return {};
    fan.add(p.x[i] - edge1.x, p.y[i] - edge1.y);
  }
  if (!fan.measure(edge1, x2, y2, sign, result)) return {};
  if (outline && j1 != j2 && sign > 0) {
    OutlineWriter writer(*outline, {edge1.x, edge1.y}, {x1, y1});
    for (int i = k;; i = next(q, i)) {
      writer.add(q.x[i] - edge1.x, q.y[i] - edge1.y);
      if (i == l) break;
    }
    outline->first_a = outline->size;
    writer.add(x2, y2);
    for (int i = j2; i != j1;) {
      i = next(p, i);
      writer.add(p.x[i] - edge1.x, p.y[i] - edge1.y);
    }
  }
  return {j1, j2};
}

struct Best {
  int edge;
  double value;    ///< signed square of the distance that q reaches inside
  double highest;  ///< <= 0: the edge separates
};

/// p's edge that q reaches inside least.
Best best_edge(const OutlineView& p, const OutlineView& q) {
  Best best{0, std::numeric_limits<double>::infinity(), 1};
  for (int i = 0; i < p.padded; i += kLanes) {
    const Wide& px = wide(p.x + i);
    const Wide& py = wide(p.y + i);
    const Wide dx = successors(p.x, i, p.padded) - px;
    const Wide dy = successors(p.y, i, p.padded) - py;
    Wide high = dx * (q.y[0] - py) - dy * (q.x[0] - px);
    for (int j = 1; j < q.size; ++j) {
      const Wide h = dx * (q.y[j] - py) - dy * (q.x[j] - px);
      high = h > high ? h : high;
    }
    const Wide square = dx * dx + dy * dy;
    const Wide size = high < 0.0 ? -high : high;
    const Wide value = high * size / square;
    for (int lane = 0; lane < kLanes; ++lane) {
      if (square[lane] > 0 && value[lane] < best.value) best = {i + lane, value[lane], high[lane]};
    }
  }
  if (best.edge >= p.size) best.edge = p.size - 1;  // the closing edge starts from the padding
  return best;
}

inline PairFeature feature_of(bool is_b, int edge) {
  return {static_cast<std::uint8_t>(is_b ? 2 : 1), static_cast<std::uint8_t>(edge)};
}

/// Nothing known helped: looks at all edges.
template <int kPadded>
[[gnu::noinline]] void search(const OutlineView& a, const OutlineView& b, PairFeature& feature, Overlap& result,
                              OverlapOutline* outline) {
  const Best of_a = best_edge(a, b);
  const Best of_b = best_edge(b, a);
  const bool is_b = of_b.value < of_a.value;
  const Best& best = is_b ? of_b : of_a;
  feature = feature_of(is_b, best.edge);
  if (best.highest <= 0) return;
  const auto found = [&](const OutlineView& p, const OutlineView& q, int edge, double sign) {
    const Set seen = above<kPadded>(q, edge_line(p, edge)) & all(q.size);
    return follow<kPadded>(p, q, edge, seen, sign, result, outline);
  };
  if (is_b) {
    const Found of = found(b, a, best.edge, -1);
    if (of.entry >= 0 && of.entry == of.exit) {
      feature = feature_of(true, of.entry);
      return;
    }
  }
  // Two edges of either polygon are cut: it is a's that are followed, so that the result has one form only.
  const Found of = found(a, b, of_a.edge, 1);
  if (of.entry >= 0) {
    feature = feature_of(false, of.entry == of_a.edge || of.exit == of_a.edge ? of_a.edge : of.entry);
  } else {
    result = clip_overlap(a, b, outline);
  }
}

/// q has vertices inside the edge that was remembered.
template <int kPadded>
[[gnu::noinline]] void touch(const OutlineView& a, const OutlineView& b, PairFeature& feature, bool is_b, int e,
                             Set seen, Overlap& result, OverlapOutline* outline) {
  const OutlineView& p = is_b ? b : a;
  const OutlineView& q = is_b ? a : b;
  seen &= all(q.size);
  const double sign = is_b ? -1 : 1;
  if (poke<kPadded>(p, q, e, edge_line(p, e), seen, sign, result)) return;
  const Found found = follow<kPadded>(p, q, e, seen, sign, result, outline);
  if (found.entry >= 0 && (!is_b || found.entry == found.exit)) {
    if (found.entry != e && found.exit != e) feature.edge = static_cast<std::uint8_t>(found.entry);
    return;
  }
  result = Overlap{};
  search<kPadded>(a, b, feature, result, outline);
}

template <int kPadded>
[[gnu::always_inline]] inline Overlap start(const OutlineView& a, const OutlineView& b, PairFeature& feature,
                                            OverlapOutline* outline) {
  const bool is_b = feature.owner == 2;
  const OutlineView& p = is_b ? b : a;
  const OutlineView& q = is_b ? a : b;
  const int e = feature.edge < p.size ? feature.edge : 0;
  const Set seen = above<kPadded>(q, edge_line(p, e));
  Overlap result;
  if (seen != 0) touch<kPadded>(a, b, feature, is_b, e, seen, result, outline);
  return result;
}

}  // namespace

Overlap overlap(const OutlineView& a, const OutlineView& b, PairFeature& feature, OverlapOutline* outline) {
  if (outline) outline->size = 0;
  assert(a.size >= 3 && b.size >= 3 && a.size + b.size <= kMaxOverlapVertices);
  if (a.padded == 8 && b.padded == 8) return start<8>(a, b, feature, outline);
  if (a.size <= kMaxFast && b.size <= kMaxFast) return start<0>(a, b, feature, outline);
  return clip_overlap(a, b, outline);
}

Overlap overlap(PolygonView a, PolygonView b, OverlapOutline* outline) {
  alignas(32) double coordinates[4][kMaxOverlapVertices];
  PairFeature unknown;
  return overlap(pack_outline(a.begin(), a.end(), coordinates[0], coordinates[1]),
                 pack_outline(b.begin(), b.end(), coordinates[2], coordinates[3]), unknown, outline);
}

}  // namespace common
