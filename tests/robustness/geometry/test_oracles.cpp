// The oracles of the differential test against closed forms, against each other and against integer arithmetic.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/robustness/geometry/clip_double_double.hpp"
#include "tests/robustness/geometry/clip_exact.hpp"
#include "tests/robustness/geometry/double_double.hpp"
#include "tests/robustness/geometry/families.hpp"
#include "tests/unit/common/geometry/exact_overlap.hpp"

using namespace differential;
using common::Vec2;

namespace {

Outline outline(std::initializer_list<Vec2> vertices) {
  Outline result;
  for (const Vec2& v : vertices) result.add(v.x(), v.y());
  return result;
}

Outline square(double x, double y, double side) {
  return outline({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

}  // namespace

TEST_CASE("double-double arithmetic has thirty-one digits") {
  const DoubleDouble third = DoubleDouble{1, 0} / DoubleDouble{3, 0};
  const DoubleDouble rest = DoubleDouble{1, 0} - third * DoubleDouble{3, 0};
  CHECK(std::abs(to_double(rest)) < 0x1p-100);
  const DoubleDouble root = DoubleDouble{1, 0x1p-80};  // (1 + e)^2 - 1 - 2 e = e^2, far below the last digit
  CHECK(to_double(root * root - DoubleDouble{1, 0}) == 0x1p-79);
  CHECK(to_double((DoubleDouble{1, 0} + DoubleDouble{0x1p-90, 0}) - DoubleDouble{1, 0}) == 0x1p-90);
}

TEST_CASE("orientation is exact where a rounded determinant has the wrong sign or none") {
  CHECK(orientation(0, 0, 1, 1, 2, 2) == 0);
  CHECK(orientation(0, 0, 1, 1, 2, std::nextafter(2, 3)) == 1);
  CHECK(orientation(0, 0, 1, 1, 2, std::nextafter(2, 1)) == -1);
  // Kettner et al., Classroom examples of robustness problems, 2008: points next to the diagonal.
  const double x = 0.5 + 0x1p-53;
  CHECK(orientation(x, 0.5, 12, 12, 24, 24) == -1);
  CHECK(orientation(0.5, x, 12, 12, 24, 24) == 1);
  CHECK(orientation(x, x, 12, 12, 24, 24) == 0);
  CHECK(orientation(0.1, 0.1, 0.2, 0.2, 0.7, 0.7) == 0);
  CHECK(orientation(0.1, 0.1, 0.2, 0.2, 0.7, std::nextafter(0.7, 1)) == 1);
}

TEST_CASE("corners that do not turn left are left out") {
  Outline flat = outline({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1 + 1e-16}, {1, std::nextafter(1, 0)}});
  CHECK(make_convex(flat) == 3);
  CHECK(flat.size == 3);
  Outline kept = square(0, 0, 1);
  CHECK(make_convex(kept) == 0);
}

TEST_CASE("both oracles give the areas of overlaps known in closed form") {
  struct {
    OutlinePair pair;
    double area;
    Vec2 chord;
  } const cases[] = {
      {{square(0, 0, 1), square(0.75, 0.5, 1)}, 0.125, {-0.25, 0.5}},
      {{square(0, 0, 1), square(0.25, 0.25, 0.5)}, 0.25, {0, 0}},
      {{square(0, 0, 1), square(0, 0, 1)}, 1, {0, 0}},
      {{square(0, 0, 1), square(1, 0, 1)}, 0, {0, 0}},
      {{square(0, 0, 1), square(1, 1, 1)}, 0, {0, 0}},
      {{square(0, 0, 1), outline({{0.5, 0.5}, {2, -1}, {2, 2}})}, 0.25, {0, 1}},
      {{square(-1, -1, 2), outline({{1.5, 0}, {0, 1.5}, {-1.5, 0}, {0, -1.5}})}, 3.5, {0, 0}},
  };
  for (const auto& c : cases) {
    const DoubleDoubleClip clip = clip_double_double(c.pair);
    CHECK(clip.area == c.area);
    CHECK(exact_area(c.pair) == c.area);
    CHECK((clip.chord - c.chord).norm() == 0);
  }
}

TEST_CASE("the double-double clip is within its own bound of the rational area, in every family") {
  for (const Family& family : families()) {
    INFO(family.name);
    int wrong = 0;
    int overlapping = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      OutlinePair pair;
      make_pair(family, seed, pair);
      make_convex(pair.a);
      make_convex(pair.b);
      const DoubleDoubleClip clip = clip_double_double(pair);
      const double exact = exact_area(pair);
      wrong += !(std::abs(clip.area - exact) <= clip.area_error);
      overlapping += exact > 0;
    }
    CHECK(wrong == 0);
    CHECK(overlapping > 40);
  }
}

TEST_CASE("the rational area is that of integer arithmetic on a grid") {
  for (const Family& family : families()) {
    INFO(family.name);
    int compared = 0;
    double worst = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      OutlinePair pair;
      make_pair(family, seed, pair);
      const auto on_grid = [](Outline& o) {
        bool small = true;
        for (int i = 0; i < o.size; ++i) {
          o.x[i] = common::test::on_grid(o.x[i]);
          o.y[i] = common::test::on_grid(o.y[i]);
          small = small && std::abs(o.x[i]) < 1 && std::abs(o.y[i]) < 1;
        }
        return small;
      };
      if (!on_grid(pair.a) || !on_grid(pair.b)) continue;
      make_convex(pair.a);
      make_convex(pair.b);
      if (pair.a.size < 3 || pair.b.size < 3) continue;
      const auto polygon = [](const Outline& o) {
        common::Polygon result;
        for (int i = 0; i < o.size; ++i) result.emplace_back(o.x[i], o.y[i]);
        return result;
      };
      const double expected = common::test::exact_overlap(polygon(pair.a), polygon(pair.b)).area;
      worst = std::max(worst, std::abs(exact_area(pair) - expected) - 0x1p-50 * expected);
      ++compared;
    }
    CHECK(compared > 150);
    CHECK(worst <= 0);
  }
}
