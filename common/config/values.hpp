// Text to values and back. Locale-free and exact: print(read(text)) keeps the value, read(print(x)) == x bit for bit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/config/specification.hpp"

namespace common {

/// A decimal number (2500, 1e9, 150.0e+6, .5); nothing for other text, NaN, infinity, or a number that a double cannot
/// hold.
std::optional<double> parse_number(std::string_view text);

/// Digits with an optional sign and no leading zero (which YAML 1.1 reads as octal); nothing for other text (1e3, 3.0)
/// or out of the type's range.
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// True for what a person would call a number, valid or not: starts with a digit, sign or dot.
bool looks_like_number(std::string_view text);

/// Shortest digits that read back as the same double, in a form that YAML 1.1 and 1.2 both read as a float: always a
/// dot, a signed exponent that is a multiple of 3: 2500.0, 0.0005, 150.0e+6.
std::string print_number(double number);

/// In double quotes, with YAML's escapes.
std::string in_quotes(std::string_view text);

/// "a number > 0", "a number in [0, 0.5)", with `noun` = "a number".
std::string describe(const Range& range, const std::string& noun);
bool contains(const Range& range, double number);

}  // namespace common
