// Most pairs of a packing either have an edge between them, the same one for many steps, or cross twice. So: test the
// remembered edge; else follow the boundaries from it to the two crossings and prove the outline that they bound. The
// proof: the vertices of either polygon on that outline lie inside the other polygon, but not all of q's, and both
// crossings are proper. So the outline runs along the boundary of the overlap, less than once round either polygon, and
// by convexity nothing else can be the overlap, wherever the search started. Everything else is clipped.
#include "common/geometry/overlap.hpp"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
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

inline unsigned size(const OutlineView& p) {
  return static_cast<unsigned>(p.size);
}
inline unsigned next(const OutlineView& p, unsigned i) {
  return i + 1 < size(p) ? i + 1 : 0;
}
inline unsigned previous(const OutlineView& p, unsigned i) {
  return i > 0 ? i - 1 : size(p) - 1;
}
inline Line edge_line(const OutlineView& p, unsigned i) {
  const unsigned j = next(p, i);
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

/// True if no vertex is on the inner side of a line.
template <int kPadded>
[[gnu::always_inline]] inline bool separates(const Line& line, const OutlineView& p) {
  Masks set{};
  for (int i = 0; i < padded<kPadded>(p); i += kLanes) {
    set |= Masks(line.dy * (wide(p.x + i) - line.x) - line.dx * (wide(p.y + i) - line.y));
  }
  return signs(Wide(set)) == 0;
}

/// The vertices i+1, ... that follow those from i on; the first one follows the last one.
[[gnu::always_inline]] inline Wide successors(const double* p, int i, int padded) {
  if (i + kLanes < padded) {
    Wide following;
    std::memcpy(&following, p + i + 1, sizeof(following));
    return following;
  }
#ifdef __AVX__
  return __builtin_shufflevector(wide(p + i), wide(p), 1, 2, 3, 4);
#else
  return __builtin_shufflevector(wide(p + i), wide(p), 1, 2);
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

/// Two crossings: where q's boundary enters and leaves p.
struct Crossings {
  unsigned entry;  ///< edge of p; kNone: not found
  unsigned exit;
  unsigned first;  ///< vertices of q in between
  unsigned last;
};
constexpr unsigned kNone = kMaxFast;
constexpr Crossings kNotFound{kNone, kNone, kNone, kNone};

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

  /// sign: 1 if the second crossing lies ahead along b's boundary. False, and nothing is set, if a triangle is turned
  /// over, which rounding does where the overlap is as thin.
  [[gnu::always_inline]] bool measure(double origin_x, double origin_y, double second_x, double second_y, double sign,
                                      Overlap& result) const {
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
    result.centroid = {origin_x + (x_ + moment_x_ * third), origin_y + (y_ + moment_y_ * third)};
    result.chord_midpoint = {origin_x + (x_ + 0.5 * cx), origin_y + (y_ + 0.5 * cy)};
    result.crossings = 2;
    return true;
  }

 private:
  double x_, y_;
  double ux_, uy_;
  double sum_ = 0, moment_x_ = 0, moment_y_ = 0;
  bool convex_ = true;
};

/// The vertices of the overlap polygon; the crossings are relative to the start of edge `entry`. Where p is a.
[[gnu::noinline]] void write(const OutlineView& p, const OutlineView& q, const Crossings& crossings, const Vec2& enters,
                             const Vec2& leaves, OverlapOutline& outline) {
  const Vec2 start = p[static_cast<int>(crossings.entry)];
  int n = 0;
  const auto add = [&](const Vec2& vertex) {
    outline.x[n] = vertex.x() - enters.x();
    outline.y[n] = vertex.y() - enters.y();
    ++n;
  };
  outline.origin = start + enters;
  add(enters);
  for (unsigned i = crossings.first;; i = next(q, i)) {
    add(q[static_cast<int>(i)] - start);
    if (i == crossings.last) break;
  }
  outline.first_a = n;
  add(leaves);
  for (unsigned i = crossings.exit; i != crossings.entry;) {
    i = next(p, i);
    add(p[static_cast<int>(i)] - start);
  }
  outline.size = n;
}

/// The overlap of p and q if it is bounded by the two crossings. sign: 1 if p is a, -1 if it is b.
/// `otherwise()` if it is not.
template <int kPadded, class Otherwise>
[[gnu::always_inline]] inline void measure(const OutlineView& p, const OutlineView& q, const Crossings& crossings,
                                           double sign, Overlap& result, OverlapOutline* outline,
                                           const Otherwise& otherwise) {
  const auto [j1, j2, k, l] = crossings;
  for (unsigned i = k;; i = next(q, i)) {
    if (!inside<kPadded>(p, q.x[i], q.y[i])) return otherwise();
    if (i == l) break;
  }
  for (unsigned i = j2; i != j1;) {
    if (sign < 0) return otherwise();  // two edges of b: the overlap polygon would have a and b exchanged
    i = next(p, i);
    if (!inside<kPadded>(q, p.x[i], p.y[i])) return otherwise();
  }
  const unsigned before = previous(q, k);
  const unsigned after = next(q, l);
  if (after == k) return otherwise();  // all of q inside: where q touches p, an outline may go round q twice
  const unsigned end1 = next(p, j1);
  const unsigned end2 = next(p, j2);
  // Entry and exit side by side: q's edges, p's edges, heights of the ends of p's edges over q's.
  const Two qx{q.x[before], q.x[l]};
  const Two qy{q.y[before], q.y[l]};
  const Two qdx = Two{q.x[k], q.x[after]} - qx;
  const Two qdy = Two{q.y[k], q.y[after]} - qy;
  const Two px{p.x[j1], p.x[j2]};
  const Two py{p.y[j1], p.y[j2]};
  const Two ends_x{p.x[end1], p.x[end2]};
  const Two ends_y{p.y[end1], p.y[end2]};
  const Two rx = px - qx;
  const Two ry = py - qy;
  const Two from = qdx * ry - qdy * rx;
  const Two to = qdx * (ends_y - qy) - qdy * (ends_x - qx);
  if ((signs(from) ^ 2) | (signs(to) ^ 1)) return otherwise();
  const Two t = from / (from - to);
  const Two tx = t * (ends_x - px);
  const Two ty = t * (ends_y - py);
  // Nearly parallel edges cross at an uncertain place, which may be beyond the end of q's edge.
  const Two along = (rx + tx) * qdx + (ry + ty) * qdy;
  const Two ahead = qdx * qdx + qdy * qdy - along;
  if ((signs(along) | signs(ahead)) != 0) return otherwise();
  const double ox = px[0];
  const double oy = py[0];
  const double x2 = (px[1] - ox) + tx[1];
  const double y2 = (py[1] - oy) + ty[1];
  Fan fan(tx[0], ty[0], q.x[k] - ox, q.y[k] - oy);
  for (unsigned i = k; i != l;) {
    i = next(q, i);
    fan.add(q.x[i] - ox, q.y[i] - oy);
  }
  fan.add(x2, y2);
  for (unsigned i = j2; i != j1;) {
    i = next(p, i);
    fan.add(p.x[i] - ox, p.y[i] - oy);
  }
  if (!fan.measure(ox, oy, x2, y2, sign, result)) return otherwise();
  if (j1 != j2 && outline) write(p, q, crossings, {tx[0], ty[0]}, {x2, y2}, *outline);
}

/// Follows the boundaries from edge e of p to the two crossings.
template <int kPadded>
Crossings follow(const OutlineView& p, const OutlineView& q, unsigned e) {
  const Set every = ~Set{0} >> (64 - q.size);
  Set in = 0;
  for (Set rest = above<kPadded>(q, edge_line(p, e)) & every; rest; rest &= rest - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(rest));
    if (inside<kPadded>(p, q.x[i], q.y[i])) in |= Set{1} << i;
  }
  const Set starts = in & ~(in << 1 | in >> (q.size - 1));
  const Set ends = in & ~(in >> 1 | (in & 1) << (q.size - 1));
  if (!std::has_single_bit(starts)) return kNotFound;
  const auto first = static_cast<unsigned>(std::countr_zero(starts));
  const auto last = static_cast<unsigned>(std::countr_zero(ends));
  // side 1: q's boundary enters p, p's leaves q; side -1: the other way round
  const auto crossing = [&](unsigned i, double side) {
    const Line line = edge_line(q, i);
    unsigned j = e;
    for (int moves = 0; moves <= p.size; ++moves) {
      const unsigned n = next(p, j);
      const double from = side * line.height(p.x[j], p.y[j]);
      const double to = side * line.height(p.x[n], p.y[n]);
      if (from > 0 && to < 0) return j;
      j = to < 0 ? previous(p, j) : n;
    }
    return kNone;
  };
  const unsigned entry = crossing(previous(q, first), 1);
  const unsigned exit = crossing(last, -1);
  return entry != kNone && exit != kNone ? Crossings{entry, exit, first, last} : kNotFound;
}

struct Best {
  unsigned edge;
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
      if (square[lane] > 0 && value[lane] < best.value)
        best = {static_cast<unsigned>(i + lane), value[lane], high[lane]};
    }
  }
  if (best.edge >= size(p)) best.edge = size(p) - 1;  // the closing edge starts from the padding
  return best;
}

inline PairFeature touching(bool of_b, const Crossings& c) {
  return {static_cast<std::uint8_t>(c.entry + (of_b ? PairFeature::kOfB : 0u)), static_cast<std::uint8_t>(c.exit + 1),
          static_cast<std::uint8_t>(c.first), static_cast<std::uint8_t>(c.last)};
}
inline PairFeature separating(bool of_b, unsigned edge) {
  return {static_cast<std::uint8_t>(edge + (of_b ? PairFeature::kOfB : 0u)), 0, 0, 0};
}
inline bool is_of_b(const PairFeature& feature) {
  return feature.edge >= PairFeature::kOfB;
}
inline unsigned edge_of(const PairFeature& feature) {
  return feature.edge % PairFeature::kOfB;
}

[[gnu::noinline]] void clip(const OutlineView& a, const OutlineView& b, Overlap& result, OverlapOutline* outline) {
  result = clip_overlap(a, b, outline);
}

/// What was known did not help: looks at all edges.
template <int kPadded>
[[gnu::noinline]] void search(const OutlineView& a, const OutlineView& b, PairFeature& feature, Overlap& result,
                              OverlapOutline* outline) {
  const Best of_a = best_edge(a, b);
  const Best of_b = best_edge(b, a);
  const bool best_of_b = of_b.value < of_a.value;
  const Best& best = best_of_b ? of_b : of_a;
  feature = separating(best_of_b, best.edge);
  if (best.highest <= 0) return;
  const auto clipped = [&] {
    feature = separating(best_of_b, best.edge);
    clip(a, b, result, outline);
  };
  const auto along_a = [&] {
    const Crossings found = follow<kPadded>(a, b, of_a.edge);
    if (found.entry == kNone) return clipped();
    feature = touching(false, found);
    return measure<kPadded>(a, b, found, 1, result, outline, clipped);
  };
  if (!best_of_b) return along_a();
  // Where two edges of either polygon are cut it is a's that count, so that the result has one form only.
  const Crossings found = follow<kPadded>(b, a, best.edge);
  if (found.entry == kNone || found.entry != found.exit) return along_a();
  feature = touching(true, found);
  return measure<kPadded>(b, a, found, -1, result, outline, along_a);
}

/// Two crossings are remembered.
template <int kPadded>
[[gnu::noinline]] void touch(const OutlineView& p, const OutlineView& q, PairFeature& feature, Overlap& result,
                             OverlapOutline* outline) {
  const bool of_b = is_of_b(feature);
  const Crossings known{edge_of(feature), feature.exit - 1u, feature.first, feature.last};
  const auto otherwise = [&] {
    return of_b ? search<kPadded>(q, p, feature, result, outline) : search<kPadded>(p, q, feature, result, outline);
  };
  const bool valid =
      (known.entry < size(p)) & (known.exit < size(p)) & (known.first < size(q)) & (known.last < size(q));
  return valid ? measure<kPadded>(p, q, known, 1 - 2 * of_b, result, outline, otherwise) : otherwise();
}

template <int kPadded>
[[gnu::always_inline]] inline void start(const OutlineView& a, const OutlineView& b, PairFeature& feature,
                                         Overlap& result, OverlapOutline* outline) {
  const bool of_b = is_of_b(feature);
  const OutlineView& p = of_b ? b : a;
  const OutlineView& q = of_b ? a : b;
  if (feature.exit != 0) return touch<kPadded>(p, q, feature, result, outline);
  const unsigned edge = edge_of(feature) < size(p) ? edge_of(feature) : 0;
  if (!separates<kPadded>(edge_line(p, edge), q)) search<kPadded>(a, b, feature, result, outline);
}

[[gnu::noinline]] void any_size(const OutlineView& a, const OutlineView& b, PairFeature& feature, Overlap& result,
                                OverlapOutline* outline) {
  if (a.size > kMaxFast || b.size > kMaxFast) return clip(a, b, result, outline);
  start<0>(a, b, feature, result, outline);
}

}  // namespace

void find_overlap(const OutlineView& a, const OutlineView& b, PairFeature& feature, Overlap& result,
                  OverlapOutline* outline) {
  assert(a.size >= 3 && b.size >= 3 && a.size + b.size <= kMaxOverlapVertices);
  if (a.padded != 8 || b.padded != 8) return any_size(a, b, feature, result, outline);
  start<8>(a, b, feature, result, outline);
}

Overlap overlap(PolygonView a, PolygonView b, OverlapOutline* outline) {
  alignas(32) double coordinates[4][kMaxOverlapVertices];
  PairFeature unknown;
  return overlap(pack_outline(a.begin(), a.end(), coordinates[0], coordinates[1]),
                 pack_outline(b.begin(), b.end(), coordinates[2], coordinates[3]), unknown, outline);
}

}  // namespace common
