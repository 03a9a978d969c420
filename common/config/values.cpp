#include "common/config/values.hpp"

#include <charconv>
#include <cmath>

namespace common {
namespace {

// Without an explicit plus sign, which from_chars does not read.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

template <class Integer>
std::optional<Integer> parse_digits(std::string_view text) {
  text = without_plus(text);
  const std::string_view digits = !text.empty() && text[0] == '-' ? text.substr(1) : text;
  if (digits.size() > 1 && digits[0] == '0') return std::nullopt;
  Integer number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// A limit as a person writes it: 1, 0.5, 10000000.
std::string print_limit(double number) {
  char buffer[400];  // the longest double without an exponent has 309 digits before the dot
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::fixed).ptr};
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  // Only these characters: from_chars would take "inf" and "nan" too.
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string_view::npos) return std::nullopt;
  text = without_plus(text);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  return parse_digits<std::int64_t>(text);
}

std::optional<std::uint64_t> parse_unsigned(std::string_view text) {
  return parse_digits<std::uint64_t>(text);
}

bool looks_like_number(std::string_view text) {
  return !text.empty() && std::string_view("0123456789+-.").find(text[0]) != std::string_view::npos;
}

std::string print_number(double number) {
  char buffer[64];
  const double size = std::fabs(number);
  if (number == 0 || (size >= 1e-4 && size < 1e6)) {
    std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::fixed).ptr);
    return text.find('.') == std::string::npos ? text + ".0" : text;
  }
  // Move the dot of d.ddde+XX so that the exponent is a multiple of 3; the digits stay, so the value does.
  const std::string text(buffer,
                         std::to_chars(buffer, buffer + sizeof buffer, size, std::chars_format::scientific).ptr);
  const std::size_t e = text.find('e');
  std::string digits = text.substr(0, 1) + (e > 2 ? text.substr(2, e - 2) : "");
  const int exponent = std::stoi(text.substr(e + 1));
  const int shift = ((exponent % 3) + 3) % 3;
  while (digits.size() < static_cast<std::size_t>(shift) + 2) digits += '0';
  const int printed = exponent - shift;
  std::string result = number < 0 ? "-" : "";
  result.append(digits, 0, shift + 1).append(".").append(digits, shift + 1);
  return result.append(printed < 0 ? "e" : "e+").append(std::to_string(printed));
}

std::string in_quotes(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string result = "\"";
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (character == '"' || character == '\\') {
      result += '\\';
      result += character;
    } else if (byte < 0x20 || byte == 0x7f) {
      result += "\\x";
      result += kHex[byte >> 4];
      result += kHex[byte & 15];
    } else {
      result += character;
    }
  }
  return result + '"';
}

std::string describe(const Range& range, const std::string& noun) {
  const bool below = std::isfinite(range.low);
  const bool above = std::isfinite(range.high);
  if (below && above) {
    return noun + " in " + (range.low_open ? '(' : '[') + print_limit(range.low) + ", " + print_limit(range.high) +
           (range.high_open ? ')' : ']');
  }
  if (below) return noun + (range.low_open ? " > " : " >= ") + print_limit(range.low);
  if (above) return noun + (range.high_open ? " < " : " <= ") + print_limit(range.high);
  return noun;
}

bool contains(const Range& range, double number) {
  return (range.low_open ? number > range.low : number >= range.low) &&
         (range.high_open ? number < range.high : number <= range.high);
}

}  // namespace common
