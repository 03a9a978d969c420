// Small tables given by the user as CSV: a label or none, then numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace common {

struct CsvRow {
  std::string where;  ///< FILE:LINE
  std::string label;  ///< first field, if the table has labels
  std::vector<double> numbers;
};

/// The rows of a file whose columns are `columns` ("type,x,y"), the first of them a label if `labelled`. Empty lines,
/// lines that start with # and a header line are skipped; fields may be padded with blanks. Throws bad_input with
/// FILE:LINE for a row of another kind, and if the file cannot be read; `content` ("outlines") names what a file
/// without rows lacks.
std::vector<CsvRow> read_csv(const std::filesystem::path& file, const std::string& columns, bool labelled,
                             const std::string& content);

/// Throws bad_input unless `file` exists and is not a directory; `content` says of what it should be a file.
void require_file(const std::filesystem::path& file, const std::string& content);

}  // namespace common
