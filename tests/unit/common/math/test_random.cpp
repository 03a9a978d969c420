#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/math/random.hpp"

using namespace common;

TEST_CASE("the generator is the standard's mt19937_64") {
  // [rand.predef]: the 10000th value with the default seed 5489 is 9981545732273789042.
  Random random(5489);
  double value = 0;
  for (int i = 0; i < 10000; ++i) value = random.uniform();
  CHECK(value == static_cast<double>(9981545732273789042ULL >> 11) / 9007199254740992.0);
}

TEST_CASE("an index in [0, 2^63) shows the generator's bits") {
  Random random(5489);
  std::uint64_t value = 0;
  for (int i = 0; i < 10000; ++i) value = random.index(std::uint64_t{1} << 63);
  CHECK(value == 9981545732273789042ULL % (std::uint64_t{1} << 63));
}

TEST_CASE("uniform numbers stay in their range and have the moments of a uniform distribution") {
  Random random(61);
  const int count = 200000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < count; ++i) {
    const double value = random.uniform(-2, 6);
    REQUIRE(value >= -2);
    REQUIRE(value < 6);
    sum += value;
    squares += (value - 2) * (value - 2);
  }
  // Five standard errors: sigma of the mean is 8 / sqrt(12 n), of the variance 64 / sqrt(180 n).
  CHECK(std::abs(sum / count - 2) < 5 * 8 / std::sqrt(12.0 * count));
  CHECK(std::abs(squares / count - 64.0 / 12) < 5 * 64 / std::sqrt(180.0 * count));
}

TEST_CASE("a range of neighbouring numbers never gives its upper end") {
  Random random(62);
  const double high = std::nextafter(1.0, 2.0);
  for (int i = 0; i < 1000; ++i) REQUIRE(random.uniform(1.0, high) == 1.0);
  CHECK(random.uniform(3.0, 3.0) == 3.0);
}

TEST_CASE("indices are unbiased") {
  Random random(63);
  std::array<int, 7> counts{};
  const int total = 700000;
  for (int i = 0; i < total; ++i) ++counts[random.index(7)];
  double chi_squared = 0;
  for (const int count : counts) chi_squared += (count - 100000.0) * (count - 100000.0) / 100000.0;
  CHECK(chi_squared < 27.9);  // 6 degrees of freedom, probability 1e-4
  for (int i = 0; i < 100; ++i) REQUIRE(random.index(1) == 0);
  // With 3 * 2^62 values, taking the remainder without rejection would make the lowest third twice as likely.
  const std::uint64_t count = 3 * (std::uint64_t{1} << 62);
  int low = 0;
  for (int i = 0; i < 30000; ++i) low += random.index(count) < count / 3 ? 1 : 0;
  CHECK(std::abs(low - 10000) < 5 * 82);
}

TEST_CASE("equal seeds give equal numbers and different seeds different ones") {
  Random one(7);
  Random same(7);
  Random other(8);
  for (int i = 0; i < 100; ++i) {
    const double value = one.uniform();
    REQUIRE(value == same.uniform());
    REQUIRE(value != other.uniform());
  }
}
