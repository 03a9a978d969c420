#include "tests/robustness/geometry/check.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tests/robustness/geometry/clip_double_double.hpp"
#include "tests/robustness/geometry/clip_exact.hpp"
#include "tests/robustness/geometry/draw.hpp"

namespace differential {
namespace {

using common::Overlap;
using common::PairFeature;
using common::Vec2;

/// The double-double area decides where its error bound is below this share of the tolerance.
constexpr double kBoundShare = 1e-3;

/// Times D / sin(angle): how far rounding moves a crossing. Its place follows from two heights, each a difference of
/// two products of differences, known to 3 u (2 L D) for an edge of length L: together 12 u, and 6 u for shifting the
/// corners to a common origin; u = 2^-53.
constexpr double kCrossing = 2e-15;

/// Times D: how far shifting to an origin up to 2 D away moves a corner, 2 u D in each coordinate.
constexpr double kShift = 3.2e-16;

/// Times D: edges nearer to each other than this may meet.
constexpr double kMeet = 1e-12;

double seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What the lines along an outline's edges may cut off it. Its corners being rounded relative to a common origin by r,
/// an edge of length L turns by 2 r / L, so that its line passes r (1 + 2 s / L) inside a corner on it at a distance s.
/// One that lies outside, the outline being convex to rounding only, is cut off by so much more. Ordinary outlines lose
/// nothing: the corner beside the edge would have to be flat to 2 r / L, 6e-10 for L = 1e-6 D.
struct CutOff {
  double depth = 0;
  double area = 0;
  std::uint64_t lines = 0;  ///< bit i: the line along edge i is one of those, by more than kMeet
};

/// What the overlap is, by the oracles.
struct Reference {
  OutlinePair convex;
  DoubleDoubleClip clip;
  double diameter = 0;
  bool exact = false;  ///< the area is the rational one
  double area = 0;
  double tolerance = 0;
  CutOff off_a, off_b;
  std::optional<Vec2> chord;  ///< if well defined
  double chord_tolerance = 0;
};

struct Box {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 high = -low;

  explicit Box(const Outline& outline) {
    for (int i = 0; i < outline.size; ++i) {
      low = low.cwiseMin(Vec2(outline.x[i], outline.y[i]));
      high = high.cwiseMax(Vec2(outline.x[i], outline.y[i]));
    }
  }
  double reach() const { return std::max(-low.minCoeff(), high.maxCoeff()); }
  bool contains(const Vec2& p, double margin) const {
    return (p.array() >= low.array() - margin).all() && (p.array() <= high.array() + margin).all();
  }
};

/// An edge from its start; `height` is the distance to its left.
struct Edge {
  Vec2 start, along;
  double length;

  Edge(const Outline& outline, int i)
      : start(outline.x[i], outline.y[i]),
        along(Vec2(outline.x[outline.next(i)], outline.y[outline.next(i)]) - start),
        length(along.norm()) {}
  Vec2 end() const { return start + along; }
  double height(const Vec2& p) const { return common::cross(along, p - start) / length; }
};

std::vector<Edge> edges_of(const Outline& outline) {
  std::vector<Edge> edges;
  for (int i = 0; i < outline.size; ++i) edges.emplace_back(outline, i);
  return edges;
}

/// How far beyond a sharp corner next to it rounding may place a point: the edges that meet there, each off by what
/// moves a crossing, meet by that much over the sine of their angle outside the outline.
double beyond_corner(const Outline& outline, const Vec2& p, double diameter) {
  double farthest = 0;
  for (int i = 0; i < outline.size; ++i) {
    const Edge from(outline, outline.previous(i)), to(outline, i);
    if (from.along.dot(to.along) >= 0) continue;
    const double sine = common::cross(from.along, to.along) / (from.length * to.length);
    const double distance = kCrossing * diameter / std::abs(sine);
    if ((p - to.start).norm() <= distance) farthest = std::max(farthest, distance);
  }
  return farthest;
}

CutOff cut_off(const Outline& outline, double diameter) {
  CutOff result;
  const double r = kShift * diameter;
  for (int i = 0; i < outline.size; ++i) {
    const Edge line(outline, i);
    double deepest = 0, farthest = 0;
    for (int k = outline.next(outline.next(i)); k != i; k = outline.next(k)) {
      const Vec2 corner(outline.x[k], outline.y[k]);
      const double height = line.height(corner);
      if (height > r * (1 + 2 * diameter / line.length)) continue;
      const double distance = (corner - line.start).norm();
      const double inside = r * (1 + 2 * distance / line.length) - height;
      if (inside <= 0) continue;
      deepest = std::max(deepest, inside);
      farthest = std::max(farthest, distance);
    }
    result.depth = std::max(result.depth, deepest);
    result.area += deepest * farthest;
    if (deepest > kMeet * diameter) result.lines |= std::uint64_t{1} << i;
  }
  return result;
}

/// Sum of 1 / sin(angle) over the pairs of edges that meet or nearly do: by so much moves the chord when a vertex does.
/// A line that cuts off a part of its outline may meet the other one beyond the ends of its edge.
double grazing(const OutlinePair& pair, const CutOff& off_a, const CutOff& off_b, double diameter) {
  const std::vector<Edge> of_a = edges_of(pair.a), of_b = edges_of(pair.b);
  const double near = kMeet * diameter + std::max(off_a.depth, off_b.depth);
  const auto apart = [near](const Edge& line, const Edge& edge) {
    const double from = line.height(edge.start), to = line.height(edge.end());
    return std::min(from, to) > near || std::max(from, to) < -near;
  };
  double sum = 0;
  for (std::size_t j = 0; j < of_b.size(); ++j) {
    const bool whole_b = off_b.lines >> j & 1;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
      const bool whole_a = off_a.lines >> i & 1;
      if ((!whole_a && apart(of_b[j], of_a[i])) || (!whole_b && apart(of_a[i], of_b[j]))) continue;
      sum += of_a[i].length * of_b[j].length / std::abs(common::cross(of_a[i].along, of_b[j].along));
    }
  }
  return sum;
}

/// The rational area, and whether the first oracle is as near to it as it says.
double verified_area(const OutlinePair& convex, const DoubleDoubleClip& clip, Tally& tally) {
  const double exact = exact_area(convex);
  ++tally.exact_checks;
  if (!(std::abs(clip.area - exact) <= clip.area_error)) ++tally.oracle_failures;
  return exact;
}

Reference refer(const Sample& sample, Tally& tally) {
  Reference reference;
  OutlinePair& pair = reference.convex = sample.pair;
  tally.not_convex += make_convex(pair.a) > 0;
  tally.not_convex += make_convex(pair.b) > 0;
  reference.diameter = std::max(diameter(pair.a), diameter(pair.b));
  const DoubleDoubleClip& clip = reference.clip = clip_double_double(pair);
  const bool decided = clip.area_error <= kBoundShare * area_tolerance(std::max(clip.area, 0.0), reference.diameter);
  tally.undecided += !decided;
  reference.exact = !decided || sample.exact;
  reference.area = reference.exact ? verified_area(pair, clip, tally) : clip.area;
  const double size = reference.diameter;
  const CutOff& off_a = reference.off_a = cut_off(sample.pair.a, size);
  const CutOff& off_b = reference.off_b = cut_off(sample.pair.b, size);
  reference.tolerance = area_tolerance(reference.area, size) + off_a.area + off_b.area;
  if (reference.area > 1e-10 * size * size) {
    const double off = kCrossing * size + std::max(off_a.depth, off_b.depth);
    reference.chord_tolerance = clip.chord_error + off * (4 + grazing(sample.pair, off_a, off_b, size));
    if (reference.chord_tolerance < 1e-6 * std::sqrt(reference.area)) reference.chord = clip.chord;
  }
  return reference;
}

/// The first thing that is wrong with an overlap; empty if nothing is.
std::string complaint(const Overlap& found, const Sample& sample, const Reference& reference, Tally& tally) {
  if (!std::isfinite(found.area) || !std::isfinite(found.width) || !found.normal.allFinite() ||
      !found.centroid.allFinite() || !found.chord_midpoint.allFinite()) {
    return "not finite";
  }
  const double share = std::abs(found.area - reference.area) / reference.tolerance;
  tally.worst_share = std::max(tally.worst_share, share);
  if (share > 1 || found.area < 0) return "area";
  if (found.area == 0) {
    const bool untouched = found.width == 0 && found.normal.isZero(0) && found.centroid.isZero(0) &&
                           found.chord_midpoint.isZero(0) && found.crossings == 0;
    return untouched ? "" : "something is set without an overlap";
  }
  const double root = std::sqrt(found.area);
  if (std::abs(found.normal.norm() - 1) > 1e-14) return "normal";
  if (found.width < root * (1 - 1e-14)) return "width below sqrt(area)";
  if (found.crossings < 0 || found.crossings % 2 != 0) return "crossings";
  const double size = reference.diameter;
  const Box box_a(sample.pair.a), box_b(sample.pair.b);
  const auto outside = [&](const Vec2& p) {
    double margin = 1e-15 * size + 0x1p-52 * std::max(box_a.reach(), box_b.reach());
    const auto beyond = [&] { return !box_a.contains(p, margin) || !box_b.contains(p, margin); };
    if (!beyond()) return false;
    margin += std::max(beyond_corner(sample.pair.a, p, size), beyond_corner(sample.pair.b, p, size));
    // An area that no double tells from a gap is somewhere along the edges that graze each other.
    if (found.area < 1e-15 * size * size) {
      margin += kCrossing * size * grazing(sample.pair, reference.off_a, reference.off_b, size);
    }
    return beyond();
  };
  if (outside(found.centroid)) return "centroid";
  if (outside(found.chord_midpoint)) return "chord midpoint";
  if (!reference.chord) return {};
  const Vec2 gradient(reference.chord->y(), -reference.chord->x());
  const double length = gradient.norm();
  const double width_error = std::abs(found.width - std::max(length, std::sqrt(reference.area))) -
                             std::abs(found.area - reference.area) / root;
  // The normal of a chord that is no more than rounding is another one, the centre line.
  const double turn = length > 1e-6 * root ? (length * found.normal - gradient).norm() : 0;
  const double chord_share = std::max(width_error, turn) / reference.chord_tolerance;
  tally.worst_chord_share = std::max(tally.worst_chord_share, chord_share);
  return chord_share > 1 ? "chord" : "";
}

/// What a query leaves when b is elsewhere.
PairFeature feature_elsewhere(const OutlinePair& pair, Kernel kernel, Draw& draw, double diameter) {
  OutlinePair moved = pair;
  const Vec2 by = draw.uniform(0, 0.3) * diameter * draw.direction();
  for (int i = 0; i < common::padded_size(moved.b.size); ++i) {
    moved.b.x[i] += by.x();
    moved.b.y[i] += by.y();
  }
  PairFeature feature;
  kernel(moved.a.view(), moved.b.view(), feature, nullptr);
  return feature;
}

/// Small numbers and now and then any, whatever the kernel keeps in its feature.
PairFeature made_up(Draw& draw, const OutlinePair& pair) {
  const int most = std::max(pair.a.size, pair.b.size);
  const auto number = [&draw](int last) {
    return static_cast<std::uint8_t>(draw.integer(0, draw.one_in(8) ? 255 : last));
  };
  PairFeature feature{number(most - 1), number(most), number(most - 1), number(most - 1)};
  if (draw.one_in(2)) feature.edge |= PairFeature::kOfB;
  return feature;
}

/// Distance of a point from the nearest line along an edge.
double distance_from_edges(const Outline& outline, const Vec2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < outline.size; ++i) {
    const Vec2 v(outline.x[i], outline.y[i]);
    const Vec2 edge = Vec2(outline.x[outline.next(i)], outline.y[outline.next(i)]) - v;
    least = std::min(least, std::abs(common::cross(edge, p - v)) / edge.norm());
  }
  return least;
}

/// The first thing that is wrong with an overlap polygon; empty if nothing is.
std::string complaint(const common::OverlapOutline& outline, const Overlap& found, const Sample& sample,
                      const Reference& reference) {
  if (outline.size == 0) return {};
  if (found.area == 0 || found.crossings != 2) return "a polygon without two crossings";
  if (outline.size < 4 || outline.size > common::kMaxOverlapVertices || outline.first_a < 2 ||
      outline.first_a > outline.size - 2) {
    return "size of the polygon";
  }
  const auto vertex = [&outline](int i) { return Vec2(outline.x[i % outline.size], outline.y[i % outline.size]); };
  const double size = reference.diameter;
  const double rounding = 1e-15 * size + 0x1p-52 * std::max(Box(sample.pair.a).reach(), Box(sample.pair.b).reach());
  // A crossing: the heights of an edge's ends over the other edge, at most two diameters away (11 roundings), its place
  // between them (3), the distance measured here (4). Storage: the vertices and the origin, their sum, its half.
  const double off = 2e-15 * size + 3 * 0x1p-52 * std::max(Box(sample.pair.a).reach(), Box(sample.pair.b).reach());
  double twice_area = 0;
  for (int i = 0; i < outline.size; ++i) {
    if (!vertex(i).allFinite()) return "polygon not finite";
    twice_area += common::cross(vertex(i), vertex(i + 1));
    const Vec2 middle = outline.origin + 0.5 * (vertex(i) + vertex(i + 1));
    const bool of_b = i < outline.first_a;
    const double within = off + (of_b ? reference.off_b : reference.off_a).depth;
    if (distance_from_edges(of_b ? sample.pair.b : sample.pair.a, middle) > within) return "polygon off the boundary";
  }
  if (!(std::abs(0.5 * twice_area - reference.area) <= reference.tolerance)) return "area of the polygon";
  const double chord = vertex(outline.first_a).norm();
  if (std::abs(std::max(chord, std::sqrt(found.area)) - found.width) > rounding) return "ends of the polygon";
  return {};
}

void check_one(Sample& sample, const Overlap& unknown, const Overlap& known, Kernel kernel, Tally& tally) {
  const Reference reference = refer(sample, tally);
  ++tally.pairs;
  tally.overlapping += reference.area > 0;
  tally.chord_checks += reference.chord.has_value();

  std::string what;
  const auto examine = [&](const char* name, const Overlap& found) {
    const std::string text = complaint(found, sample, reference, tally);
    if (!text.empty() && what.empty()) what = text + name;
  };
  examine("", unknown);
  examine(", from the pair's feature", known);
  const common::OutlineView a = sample.pair.a.view();
  const common::OutlineView b = sample.pair.b.view();
  Draw draw(
      static_cast<std::uint64_t>(sample.key[0] + 31 * (sample.key[1] + 31 * (sample.key[2] + 31 * sample.key[3]))));
  common::OverlapOutline outline;
  const auto examine_outline = [&](const Overlap& found) {
    tally.outlines += outline.size > 0;
    const std::string text = complaint(outline, found, sample, reference);
    if (!text.empty() && what.empty()) what = text;
  };
  PairFeature other = made_up(draw, sample.pair);
  Overlap again = kernel(a, b, other, &outline);
  examine(", from a feature made up", again);
  examine_outline(again);
  other = feature_elsewhere(sample.pair, kernel, draw, reference.diameter);
  again = kernel(a, b, other, &outline);
  examine(", from a feature of another place", again);
  examine_outline(again);
  other = {};
  Overlap exchanged = kernel(b, a, other, nullptr);
  exchanged.normal *= -1;
  examine(", exchanged", exchanged);

  if (what.empty()) return;
  if (!reference.exact) verified_area(reference.convex, reference.clip, tally);
  ++tally.disagreements;
  ++tally.kinds[what];
  tally.add(Failure{sample.key, what});
}

}  // namespace

double area_tolerance(double exact, double diameter) {
  return 1e-10 * exact + 1e-15 * diameter * diameter;
}

void Tally::add(const Failure& failure) {
  failures.insert(std::upper_bound(failures.begin(), failures.end(), failure), failure);
  if (failures.size() > kFailuresKept) failures.pop_back();
}

void Tally::add(const Tally& other) {
  pairs += other.pairs;
  overlapping += other.overlapping;
  exact_checks += other.exact_checks;
  undecided += other.undecided;
  chord_checks += other.chord_checks;
  outlines += other.outlines;
  not_convex += other.not_convex;
  disagreements += other.disagreements;
  oracle_failures += other.oracle_failures;
  worst_share = std::max(worst_share, other.worst_share);
  worst_chord_share = std::max(worst_chord_share, other.worst_chord_share);
  seconds_unknown += other.seconds_unknown;
  seconds_cached += other.seconds_cached;
  for (const auto& [kind, count] : other.kinds) kinds[kind] += count;
  for (const Failure& failure : other.failures) add(failure);
}

void check(std::span<Sample> samples, Kernel kernel, Tally& tally) {
  std::vector<Overlap> unknown(samples.size());
  std::vector<Overlap> known(samples.size());
  const double start = seconds();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    PairFeature feature;
    unknown[k] = kernel(samples[k].pair.a.view(), samples[k].pair.b.view(), feature, nullptr);
  }
  const double middle = seconds();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    known[k] = kernel(samples[k].pair.a.view(), samples[k].pair.b.view(), samples[k].feature, nullptr);
  }
  const double end = seconds();
  tally.seconds_unknown += middle - start;
  tally.seconds_cached += end - middle;
  for (std::size_t k = 0; k < samples.size(); ++k) check_one(samples[k], unknown[k], known[k], kernel, tally);
}

std::string describe(const Sample& sample, Kernel kernel) {
  std::string text;
  const auto write = [&text](const char* name, const Outline& outline) {
    for (int i = 0; i < outline.size; ++i) {
      text += fmt::format("{} {:2} {:24a} {:24a}  {:.17g} {:.17g}\n", name, i, outline.x[i], outline.y[i], outline.x[i],
                          outline.y[i]);
    }
  };
  write("a", sample.pair.a);
  write("b", sample.pair.b);
  OutlinePair pair = sample.pair;
  const int left_out = make_convex(pair.a) + make_convex(pair.b);
  const double size = std::max(diameter(pair.a), diameter(pair.b));
  const DoubleDoubleClip clip = clip_double_double(pair);
  const double exact = exact_area(pair);
  const CutOff off_a = cut_off(sample.pair.a, size), off_b = cut_off(sample.pair.b, size);
  text += fmt::format("corners that do not turn left {}\n", left_out);
  text += fmt::format("exact area        {:.17g}, tolerance {:.3g}\n", exact, area_tolerance(exact, size));
  text += fmt::format(
      "double-double     {:.17g} +- {:.2g}, chord ({:.17g}, {:.17g}) +- {:.2g}, grazing {:.3g}, "
      "cut off ({:.3g} m, {:.3g} m^2), ({:.3g}, {:.3g})\n",
      clip.area, clip.area_error, clip.chord.x(), clip.chord.y(), clip.chord_error,
      grazing(sample.pair, off_a, off_b, size), off_a.depth, off_a.area, off_b.depth, off_b.area);
  const auto write_overlap = [&](const char* name, const Overlap& o) {
    text += fmt::format(
        "{} area {:.17g} (share {:.3g}), width {:.17g}, normal ({:.17g}, {:.17g}), centroid ({:.17g}, {:.17g}), "
        "chord midpoint ({:.17g}, {:.17g}), crossings {}\n",
        name, o.area, std::abs(o.area - exact) / area_tolerance(exact, size), o.width, o.normal.x(), o.normal.y(),
        o.centroid.x(), o.centroid.y(), o.chord_midpoint.x(), o.chord_midpoint.y(), o.crossings);
  };
  PairFeature feature;
  write_overlap("kernel, unknown  ", kernel(sample.pair.a.view(), sample.pair.b.view(), feature, nullptr));
  feature = sample.feature;
  write_overlap("kernel, feature  ", kernel(sample.pair.a.view(), sample.pair.b.view(), feature, nullptr));
  feature = {};
  write_overlap("kernel, exchanged", kernel(sample.pair.b.view(), sample.pair.a.view(), feature, nullptr));
  return text;
}

}  // namespace differential
