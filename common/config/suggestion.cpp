#include "common/config/suggestion.hpp"

#include <algorithm>
#include <cctype>

namespace common {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& names) {
  std::string plain(name.substr(0, 100));  // long enough for any key; the distance costs the product of the lengths
  for (char& character : plain) {
    character = character == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  }
  std::string best;
  int smallest = 0;
  for (const std::string& candidate : names) {
    const int distance = edit_distance(plain, candidate);
    const int allowed = std::max(1, static_cast<int>(std::max(plain.size(), candidate.size())) / 3);
    if (distance <= allowed && (best.empty() || distance < smallest)) {
      best = candidate;
      smallest = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& names, const std::string& otherwise) {
  const std::string near = nearest_name(name, names);
  if (!near.empty()) return "; did you mean \"" + near + "\"?";
  return "; " + otherwise + join(names);
}

std::string join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace common
