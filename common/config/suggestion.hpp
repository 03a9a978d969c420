// "Did you mean": the nearest of some names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace common {

/// Smallest number of insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b` (optimal
/// string alignment).
int edit_distance(std::string_view a, std::string_view b);

/// The nearest of `names`, if it is near enough to be a slip (a third of its letters, at least 1); otherwise empty.
std::string nearest_name(std::string_view name, const std::vector<std::string>& names);

/// `; did you mean "X"?` if a name is near, otherwise `; ` + `otherwise` + the names.
std::string suggestion(std::string_view name, const std::vector<std::string>& names, const std::string& otherwise);

/// a, b, c
std::string join(const std::vector<std::string>& names);

}  // namespace common
