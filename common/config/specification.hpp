// One specification of keys: it validates a YAML file, fills in defaults, prints the resolved configuration and
// documents itself. A key is bound to a member of a plain struct, whose initializer is the default.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace common {

/// Which executable's `config_hash` covers the key.
enum class UsedBy { dem, xfem, both, neither };

/// Closed or open numeric range; an end that is infinite is no limit.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
};
inline constexpr Range kPositive{0, std::numeric_limits<double>::infinity(), true, false};
inline constexpr Range kNonNegative{0, std::numeric_limits<double>::infinity(), false, false};
inline constexpr Range kAny{};

/// One documented key. `path` is dotted (contact.friction).
struct Key {
  std::string path;
  std::string unit;         ///< "-" for none
  std::string description;  ///< one sentence, with the source where there is one
  std::string expected;     ///< e.g. "a number in (0, 1]", "one of mean_depth, area, potential"
  UsedBy used_by = UsedBy::both;
};

/// Command-line override `path=value`, validated like the file.
using Overrides = std::vector<std::string>;

}  // namespace common
