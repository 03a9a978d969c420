#include "common/config/values.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "common/config/suggestion.hpp"

using namespace common;

TEST_CASE("Printed numbers read back as the same double, by strtod as well") {
  std::mt19937_64 bits(7);
  int tried = 0;
  while (tried < 50'000) {
    const auto number = std::bit_cast<double>(bits());
    if (!std::isfinite(number)) continue;
    ++tried;
    const std::string text = print_number(number);
    REQUIRE(std::strtod(text.c_str(), nullptr) == number);
    REQUIRE(parse_number(text) == number);
    // What YAML 1.1 (PyYAML) calls a float: a dot, and a sign after the e.
    const std::size_t e = text.find('e');
    REQUIRE(text.substr(0, e).find('.') != std::string::npos);
    REQUIRE((e == std::string::npos || text[e + 1] == '+' || text[e + 1] == '-'));
  }
  for (double number = 1e-12; number < 1e15; number *= 1.7) REQUIRE(parse_number(print_number(number)) == number);
}

TEST_CASE("Numbers print in engineering notation or as plain decimals") {
  CHECK(print_number(150e6) == "150.0e+6");
  CHECK(print_number(1e9) == "1.0e+9");
  CHECK(print_number(20e9) == "20.0e+9");
  CHECK(print_number(1.25e8) == "125.0e+6");
  CHECK(print_number(1.2345e8) == "123.45e+6");
  CHECK(print_number(999999) == "999999.0");
  CHECK(print_number(1e6) == "1.0e+6");
  CHECK(print_number(2500) == "2500.0");
  CHECK(print_number(0.0005) == "0.0005");
  CHECK(print_number(5e-5) == "50.0e-6");
  CHECK(print_number(-1.5e-9) == "-1.5e-9");
  CHECK(print_number(0) == "0.0");
  CHECK(print_number(0.1) == "0.1");
}

TEST_CASE("Numbers are decimal, finite and complete") {
  CHECK(parse_number("2500") == 2500.0);
  CHECK(parse_number("1e9") == 1e9);
  CHECK(parse_number("150.0e+6") == 150e6);
  CHECK(parse_number(".5") == 0.5);
  CHECK(parse_number("5.") == 5.0);
  CHECK(parse_number("+3") == 3.0);
  CHECK(parse_number("-3") == -3.0);
  for (const char* text : {"",      "abc", ".nan",  ".inf", "-.inf", "nan", "inf", "infinity", "1e999", "0x10",
                           "1_000", "1 2", "1.2.3", "+-3",  "--3",   "e5",  ".",   "-",        "1e",    "0.5m"}) {
    INFO(text);
    CHECK_FALSE(parse_number(text));
  }
}

TEST_CASE("Integers are written in digits only") {
  CHECK(parse_integer("0") == 0);
  CHECK(parse_integer("+12") == 12);
  CHECK(parse_integer("-12") == -12);
  CHECK(parse_unsigned("18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
  for (const char* text : {"", "1e3", "3.0", "010", "-012", "0x10", "9223372036854775808", "a", "1_0", " 1", "+-1"}) {
    INFO(text);
    CHECK_FALSE(parse_integer(text));
  }
  CHECK_FALSE(parse_unsigned("-1"));
  CHECK_FALSE(parse_unsigned("18446744073709551616"));
}

TEST_CASE("Ranges are described and tested at both kinds of end") {
  const Range half_open{0, 0.5, false, true};
  CHECK(describe(half_open, "a number") == "a number in [0, 0.5)");
  CHECK(contains(half_open, 0));
  CHECK_FALSE(contains(half_open, 0.5));
  const Range other{0, 1, true, false};
  CHECK(describe(other, "a number") == "a number in (0, 1]");
  CHECK_FALSE(contains(other, 0));
  CHECK(contains(other, 1));
  CHECK(describe(kPositive, "a number") == "a number > 0");
  CHECK(describe(kNonNegative, "a number") == "a number >= 0");
  CHECK(describe(kAny, "a number") == "a number");
  CHECK(describe(Range{-std::numeric_limits<double>::infinity(), 3}, "a number") == "a number <= 3");
  CHECK(describe(Range{1, 1e7}, "an integer") == "an integer in [1, 10000000]");
}

TEST_CASE("The edit distance counts insertions, deletions, substitutions and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("stifness", "stiffness") == 1);
  CHECK(edit_distance("frictoin", "friction") == 1);
  CHECK(edit_distance("saturday", "sunday") == 3);
}

TEST_CASE("The nearest name is suggested only if it is a likely slip") {
  const std::vector<std::string> names{"law", "normal_stiffness", "tangential_stiffness", "friction"};
  CHECK(nearest_name("normal_stifness", names) == "normal_stiffness");
  CHECK(nearest_name("Normal-Stiffness", names) == "normal_stiffness");
  CHECK(nearest_name("laws", names) == "law");
  CHECK(nearest_name("zork", names).empty());
  CHECK(nearest_name("", names).empty());
  CHECK(suggestion("zork", {"a_long_name", "other"}, "expected one of ") == "; expected one of a_long_name, other");
}
