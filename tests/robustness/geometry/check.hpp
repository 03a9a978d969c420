// Pairs through the overlap kernel and through the oracles; what differs is counted.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "tests/robustness/geometry/outlines.hpp"

namespace differential {

/// The kernel under test; the harness tests itself by handing in wrong ones.
using Kernel = common::Overlap (*)(const common::OutlineView&, const common::OutlineView&, common::PairFeature&,
                                   common::OverlapOutline*);

/// What reproduces a pair: {seed} of its family, or {frame, step, id of a, id of b} of a harvest.
using CaseKey = std::array<std::int64_t, 4>;

struct Sample {
  OutlinePair pair;
  common::PairFeature feature;  ///< what the pair's previous query left; zero: nothing
  CaseKey key{};
  bool exact = false;  ///< to be checked in exact arithmetic, too
};

struct Failure {
  CaseKey key{};
  std::string what;
  auto operator<=>(const Failure&) const = default;
};

/// Counts of a family. Adding is commutative (times apart), so that they do not depend on the number of threads.
struct Tally {
  static constexpr std::size_t kFailuresKept = 10;

  std::int64_t pairs = 0;
  std::int64_t overlapping = 0;      ///< area above 0 by the oracles
  std::int64_t exact_checks = 0;     ///< in rational numbers, for whatever reason
  std::int64_t undecided = 0;        ///< of these, pairs for which the bound of the first oracle did not suffice
  std::int64_t chord_checks = 0;     ///< pairs whose chord is well defined
  std::int64_t outlines = 0;         ///< overlap polygons that the kernel handed out
  std::int64_t not_convex = 0;       ///< outlines with a corner that rounding made flat or reentrant
  std::int64_t disagreements = 0;    ///< pairs with anything wrong
  std::int64_t oracle_failures = 0;  ///< the two oracles differ by more than the first one's bound
  double worst_share = 0;            ///< largest |A - A_exact| / what is allowed
  double worst_chord_share = 0;
  double seconds_unknown = 0;                 ///< in the kernel, nothing known of the pair
  double seconds_cached = 0;                  ///< in the kernel, starting from the pair's feature
  std::map<std::string, std::int64_t> kinds;  ///< disagreements by kind
  std::vector<Failure> failures;              ///< the first ones by key

  void add(const Failure& failure);
  void add(const Tally& other);
};

/// What common::overlap promises but for short edges: 1e-10 exact + 1e-15 D^2, D the larger diameter.
double area_tolerance(double exact, double diameter);

/// Checks every sample and leaves the pair's feature in it, as the engine does. Per pair:
///  - area against the oracle: nothing known, with the sample's feature, with the feature just learned, with a feature
///    made up, with one learned at another place, and with a and b exchanged;
///  - finite numbers, unit normal, width >= sqrt(area), an even number of crossings, nothing set without an overlap;
///  - centroid and chord midpoint inside both bounding boxes; next to a sharp corner they may be out by rounding over
///    its sine, an area below 1e-15 D^2 by rounding over the sine of the angle at which edges graze each other;
///  - width * normal against the oracle's chord, -dA/d(position of b), where edges that meet do not do so at a grazing
///    angle: within rounding over the sine of that angle;
///  - of an outline with a corner that is straight, to rounding, beside a short edge, area and chord within what the
///    line along that edge cuts off: rounding over the length of the edge.
///  - the overlap polygon, if there is one: its area within the tolerance, its pieces on the boundaries that it names,
///    from crossing to crossing; and nobody's answer changed by asking for it.
void check(std::span<Sample> samples, Kernel kernel, Tally& tally);

/// Everything known of one pair, for reading.
std::string describe(const Sample& sample, Kernel kernel);

}  // namespace differential
