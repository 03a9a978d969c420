#include <catch2/catch.hpp>
#include <cmath>

#include "common/error.hpp"
#include "xfem/lab/first_failure.hpp"

using namespace xfem;

TEST_CASE("with a held confining stress first failure lies on the Hoek-Brown envelope") {
  const HoekBrown rock{150e6, 25};
  for (const double s3 : {0.5e6, 1e6, 2e6, 4e6, 10e6, 30e6, 300e6}) {
    const double factor = failure_factor(rock, {s3, s3, 0}, {0, 1e6, 0});
    const double strength = s3 + 150e6 * std::sqrt(25 * s3 / 150e6 + 1);
    CHECK(std::abs((s3 + factor * 1e6) / strength - 1) < 1e-14);
  }
}

TEST_CASE("without held stress first failure is the criterion's own load factor") {
  const HoekBrown rock{100e6, 10};
  const Stress stress{3e6, -2e6, 1e6};
  const PrincipalStress p = principal(stress);
  CHECK(failure_factor(rock, {}, stress) == rock.load_factor(p.s1, p.s3));
  // The root along the path is the same as the closed form when the held stress is a part of the load itself.
  const double whole = failure_factor(rock, {}, stress);
  const double rest = failure_factor(rock, {0.5 * stress.xx, 0.5 * stress.yy, 0.5 * stress.xy}, stress);
  CHECK(rest + 0.5 == Approx(whole).epsilon(1e-13));
}

TEST_CASE("a stress that never fails has no factor, one that fails while held is refused") {
  const HoekBrown rock{150e6, 25};
  CHECK(std::isinf(failure_factor(rock, {1e6, 1e6, 0}, {1e6, 1e6, 0})));
  CHECK_THROWS_WITH(failure_factor(rock, {0, 200e6, 0}, {0, 1e6, 0}), Catch::Contains("fails before the load grows"));
}

TEST_CASE("of elements that fail together the one nearest to the middle is named") {
  const HoekBrown rock{150e6, 25};
  const std::vector<Stress> stress{{0, 1e6, 0}, {0, 1e6 * (1 + 1e-13), 0}, {0, 1e6 * (1 - 1e-13), 0}};
  const std::vector<Vec2> centers{{1, 0}, {2, 0}, {-0.5, 0}};
  CHECK(first_failure(rock, {}, stress, centers).element == 2);
  CHECK(first_failure(rock, {}, stress, centers).factor == Approx(150).epsilon(1e-12));
}
