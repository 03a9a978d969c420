#include "common/config/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "common/config/values.hpp"
#include "common/error.hpp"

namespace common {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// All numbers of the fields; `words` counts the fields that do not even look like one.
std::optional<std::vector<double>> parse_numbers(const std::vector<std::string>& fields, std::size_t first,
                                                 std::size_t& words) {
  std::vector<double> numbers;
  words = 0;
  for (std::size_t i = first; i < fields.size(); ++i) {
    if (const auto number = parse_number(fields[i])) numbers.push_back(*number);
    if (!looks_like_number(fields[i])) ++words;
  }
  return numbers.size() == fields.size() - first ? std::optional(numbers) : std::nullopt;
}

}  // namespace

std::vector<CsvRow> read_csv(const std::filesystem::path& file, const std::string& columns, bool labelled,
                             const std::string& content) {
  errno = 0;
  std::ifstream stream(file);
  if (!stream) throw bad_input(file.string() + ": the file cannot be read: " + std::strerror(errno));
  const std::size_t first = labelled ? 1 : 0;
  const auto count = static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ',')) + 1;
  std::vector<CsvRow> rows;
  std::string line;
  bool header_allowed = true;
  for (int number = 1; std::getline(stream, line); ++number) {
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(trimmed(field));
    const std::string where = fmt::format("{}:{}", file.string(), number);
    std::size_t words = 0;
    const auto numbers = fields.size() == count ? parse_numbers(fields, first, words) : std::nullopt;
    if (numbers) {
      rows.push_back({where, labelled ? fields[0] : std::string(), *numbers});
    } else if (!header_allowed || words != count - first) {
      throw bad_input(
          fmt::format("{}: found {}, expected {} with {} numbers", where, in_quotes(line), columns, count - first));
    }
    header_allowed = false;
  }
  if (rows.empty()) {
    throw bad_input(fmt::format("{}: the file has no {}, expected rows of {}", file.string(), content, columns));
  }
  return rows;
}

void require_file(const std::filesystem::path& file, const std::string& content) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw bad_input(file.string() + ": the file does not exist");
  }
  if (status.type() == std::filesystem::file_type::none) {
    throw bad_input(file.string() + ": the file cannot be read: " + error.message());
  }
  if (status.type() == std::filesystem::file_type::directory) {
    throw bad_input(file.string() + ": found a directory, expected a file of " + content);
  }
}

}  // namespace common
