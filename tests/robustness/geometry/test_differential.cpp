// The overlap kernel against the oracles, in a few seconds; and the harness against kernels that are wrong.
#include <omp.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/chord_split.hpp"
#include "dem/fragments.hpp"
#include "dem/stages/control.hpp"
#include "dem/stages/generate.hpp"
#include "tests/robustness/geometry/clip_exact.hpp"
#include "tests/robustness/geometry/families.hpp"
#include "tests/robustness/geometry/harvest.hpp"
#include "tests/robustness/geometry/run_family.hpp"

using namespace differential;
using common::OutlineView;
using common::Overlap;
using common::OverlapOutline;
using common::PairFeature;
using common::Vec2;

namespace {

std::string text_of(const Tally& tally) {
  std::string text = "worst share " + std::to_string(tally.worst_share);
  for (const auto& [kind, count] : tally.kinds) text += "; " + std::to_string(count) + " pairs: " + kind;
  for (const Failure& failure : tally.failures) text += "\n  " + std::to_string(failure.key[0]) + " " + failure.what;
  return text;
}

Tally run_all(Kernel kernel, std::int64_t each) {
  Tally sum;
  for (const Family& family : families()) sum.add(run_family(family, each, 0, 0, kernel));
  return sum;
}

/// A loose assembly pressed together until about two thirds of the particles carry load.
dem::Engine packing(const common::Scene& scene) {
  dem::State state;
  state.particles = dem::generate_assembly(scene.assembly, scene.material.density, scene.seed);
  state.next_id = scene.assembly.particles;
  state.friction = 0.5;
  dem::Engine engine(scene, state);
  dem::outline_ring(engine);
  for (int k = 0; k < 100000 && engine.contacts() < 40; ++k) {
    engine.scale_positions(common::Vec2::Constant(1 - 1e-4));
    engine.step({});
  }
  dem::renew_ring(engine);
  for (int k = 0; k < 20000 && engine.contacts() < 100; ++k) engine.step({0.2, 0.2});
  return engine;
}

common::Scene small_scene() {
  common::Scene scene;
  scene.effects = {true, true, false, false};
  scene.assembly.particles = 60;
  return scene;
}

/// Every second free particle loses a splinter along its first edge.
void splinter(dem::Engine& engine, double density) {
  common::Split split;
  const auto& p = engine.state().particles;
  for (std::size_t i = 0; i < p.size(); i += 2) {
    if (p.boundary[i]) continue;
    const auto outline = p.outline(i);
    const Vec2 first = outline[0] + 0.02 * (outline.back() - outline[0]);
    const Vec2 last = outline[1] + 0.03 * (outline[2] - outline[1]);
    const auto pieces = common::split_by_chord(outline, first, last);
    split.broken.parent.push_back(p.id[i]);
    split.broken.path.push_back({first, last});
    for (const auto& piece : {pieces.left, pieces.right}) {
      split.fragments.id.push_back(engine.state().next_id + static_cast<std::int64_t>(split.fragments.id.size()));
      split.fragments.parent.push_back(p.id[i]);
      split.fragments.vertices.insert(split.fragments.vertices.end(), piece.begin(), piece.end());
      split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));
    }
  }
  dem::apply_split(engine.edit(), split, density);
  engine.restart();
}

template <class Change>
Overlap changed(const OutlineView& a, const OutlineView& b, PairFeature& feature, OverlapOutline* outline,
                const Change& change) {
  Overlap result = common::overlap(a, b, feature, outline);
  if (result.area > 0) change(result);
  return result;
}

/// Queries from every edge and vertex that a feature can name, and one beyond; the wrong areas among them, those of the
/// overlap polygons included.
struct Every {
  std::int64_t queries = 0;
  std::int64_t wrong = 0;
};
void query_every_feature(const OutlinePair& pair, Every& every) {
  OutlinePair convex = pair;
  make_convex(convex.a);
  make_convex(convex.b);
  const double exact = exact_area(convex);
  const double tolerance = area_tolerance(exact, std::max(diameter(pair.a), diameter(pair.b)));
  const int most = std::max(pair.a.size, pair.b.size);
  OverlapOutline outline;
  for (const unsigned of_b : {0u, PairFeature::kOfB}) {
    for (int code = 0; code < (most + 1) * (most + 1) * (most + 1) * (most + 2); ++code) {
      PairFeature feature;
      int rest = code;
      const auto digit = [&rest](int base) {
        const int value = rest % base;
        rest /= base;
        return static_cast<std::uint8_t>(value);
      };
      feature.edge = static_cast<std::uint8_t>(digit(most + 1) + of_b);
      feature.first = digit(most + 1);
      feature.last = digit(most + 1);
      feature.exit = digit(most + 2);
      const Overlap found = common::overlap(pair.a.view(), pair.b.view(), feature, &outline);
      ++every.queries;
      every.wrong += !(std::abs(found.area - exact) <= tolerance);
      if (outline.size == 0) continue;
      double twice = 0;
      for (int i = 0, j = outline.size - 1; i < outline.size; j = i++) {
        twice += outline.x[j] * outline.y[i] - outline.x[i] * outline.y[j];
      }
      every.wrong += !(std::abs(0.5 * twice - exact) <= tolerance);
    }
  }
}
const Family& family_of(const std::string& name) {
  return *std::find_if(families().begin(), families().end(), [&](const Family& f) { return f.name == name; });
}

}  // namespace

TEST_CASE("the overlap kernel agrees with the oracles on random and adversarial pairs of every family") {
  for (const Family& family : families()) {
    const Tally tally = run_family(family, 14000, 0, 100, common::overlap);
    INFO(family.name << ": " << text_of(tally));
    CHECK(tally.pairs == 14000);
    CHECK(tally.exact_checks >= 140);
    CHECK(tally.overlapping > 2800);
    CHECK(tally.disagreements == 0);
    CHECK(tally.oracle_failures == 0);
  }
}

TEST_CASE("every value of a feature gives the exact area") {
  OutlinePair pair;
  SECTION("of pairs of every family") {
    for (const Family& family : families()) {
      Every every;
      for (std::uint64_t seed = 0; seed < 300; ++seed) {
        make_pair(family, seed, pair);
        if (pair.a.size <= 4 && pair.b.size <= 4) query_every_feature(pair, every);
      }
      INFO(family.name << ": " << every.queries << " queries");
      CHECK(every.wrong == 0);
    }
  }
  SECTION("of polygons that touch another from inside, round which an outline fits twice") {
    const std::pair<const char*, std::vector<std::uint64_t>> cases[] = {
        {"inclusion", {1313, 252438, 667918, 985080, 2021525, 2044442, 2932561, 3007831, 6378746}},
        {"lattice", {725, 18538}}};
    for (const auto& [name, seeds] : cases) {
      for (const std::uint64_t seed : seeds) {
        make_pair(family_of(name), seed, pair);
        Every every;
        query_every_feature(pair, every);
        INFO(name << ":" << seed);
        CHECK(every.queries > 0);
        CHECK(every.wrong == 0);
      }
    }
  }
}

TEST_CASE("the overlap kernel agrees with the oracles in a packing that is sheared, whole and splintered") {
  const common::Scene scene = small_scene();
  dem::Engine engine = packing(scene);
  const bool broken = GENERATE(false, true);
  const bool world = GENERATE(false, true);
  if (broken) splinter(engine, scene.material.density);
  Tally tally;
  HarvestOptions options;
  options.pairs = 10000;
  options.steps = 1500;
  options.exact_stride = 100;
  options.world = world;
  harvest(engine, scene, 0, options, common::overlap, tally);
  INFO((broken ? "splintered" : "whole") << (world ? ", world coordinates: " : ": ") << text_of(tally));
  CHECK(tally.pairs >= 10000);
  CHECK(tally.overlapping > tally.pairs / 4);
  CHECK(tally.disagreements == 0);
  CHECK(tally.oracle_failures == 0);
}

TEST_CASE("the counts do not depend on the number of threads") {
  const int threads = omp_get_max_threads();
  const auto off = [](const OutlineView& a, const OutlineView& b, PairFeature& feature, OverlapOutline* outline) {
    return changed(a, b, feature, outline, [](Overlap& o) { o.area *= 1 + 1e-9; });
  };
  omp_set_num_threads(1);
  const Tally one = run_all(off, 300);
  omp_set_num_threads(3);
  const Tally three = run_all(off, 300);
  omp_set_num_threads(threads);
  CHECK(one.failures == three.failures);
  CHECK(one.kinds == three.kinds);
  CHECK(one.worst_share == three.worst_share);
  CHECK(one.worst_chord_share == three.worst_chord_share);
  CHECK(one.overlapping == three.overlapping);
  CHECK(one.disagreements == three.disagreements);
}

TEST_CASE("a harvested pair is found again by its key") {
  const common::Scene scene = small_scene();
  const auto off = [](const OutlineView& a, const OutlineView& b, PairFeature& feature, OverlapOutline* outline) {
    return changed(a, b, feature, outline, [](Overlap& o) { o.area *= 1 + 1e-9; });
  };
  HarvestOptions options;
  options.pairs = 3000;
  Tally tally;
  dem::Engine first = packing(scene);
  harvest(first, scene, 0, options, off, tally);
  REQUIRE(!tally.failures.empty());
  dem::Engine second = packing(scene);
  auto sample = harvested_sample(second, scene, tally.failures.back().key, options, common::overlap);
  REQUIRE(sample);
  Tally again;
  check(std::span(&*sample, 1), off, again);
  CHECK(again.disagreements == 1);
}

TEST_CASE("a kernel that is wrong in one respect does not pass") {
  struct {
    const char* what;
    Kernel kernel;
  } const wrong[] = {
      {"area off by 1e-9",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [](Overlap& o) { o.area *= 1 - 1e-9; });
       }},
      {"shallow contacts missed",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         const Overlap found = common::overlap(a, b, f, outline);
         return found.area < 1e-12 ? Overlap{} : found;
       }},
      {"no number",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [](Overlap& o) {
           if (o.crossings == 0) o.normal.x() = std::numeric_limits<double>::quiet_NaN();
         });
       }},
      {"normal turned by 1e-7",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [](Overlap& o) { o.normal += 1e-7 * common::perpendicular(o.normal); });
       }},
      {"normal from b to a",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [](Overlap& o) { o.normal *= -1; });
       }},
      {"width off by 1e-8",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [](Overlap& o) { o.width *= 1 + 1e-8; });
       }},
      {"only two crossings known",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         const Overlap found = common::overlap(a, b, f, outline);
         return found.crossings > 2 ? Overlap{} : found;
       }},
      {"centroid of the second particle",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [&](Overlap& o) {
           o.centroid = {b.x[0] + b.x[0] - b.x[1], b.y[0] + b.y[0] - b.y[1]};
         });
       }},
      {"a feature of another place trusted",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         const bool known = f.edge > 0;
         const Overlap found = common::overlap(a, b, f, outline);
         return known && b.x[0] < 0.2 ? Overlap{} : found;
       }},
      {"overlap polygon too large",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         const Overlap found = common::overlap(a, b, f, outline);
         if (outline && outline->size > 0) outline->x[1] *= 1 + 1e-9;
         return found;
       }},
      {"overlap polygon from the wrong end",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         const Overlap found = common::overlap(a, b, f, outline);
         if (outline && outline->size > 0) outline->first_a = outline->size - outline->first_a;
         return found;
       }},
      {"another answer when exchanged",
       [](const OutlineView& a, const OutlineView& b, PairFeature& f, OverlapOutline* outline) {
         return changed(a, b, f, outline, [&](Overlap& o) { o.area *= a.size > b.size ? 1 + 1e-9 : 1; });
       }},
  };
  for (const auto& [what, kernel] : wrong) {
    const Tally tally = run_all(kernel, 100);
    INFO(what << ": " << text_of(tally));
    CHECK(tally.disagreements > 10);
    CHECK(tally.oracle_failures == 0);
  }
}
