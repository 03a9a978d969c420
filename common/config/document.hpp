// A YAML document as a plain tree in which every value knows where it stands. The only reader of YAML in the project.
// The tree keeps what a generic YAML library drops: duplicate keys, quotes, and the place of every key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace common {

struct Value {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  std::string text;          ///< of a scalar
  bool quoted = false;       ///< a scalar written in quotes is never a number, a boolean or `auto`
  std::string where;         ///< FILE:LINE:COLUMN (1-based), or `--set KEY=VALUE`
  std::vector<Value> keys;   ///< of a map: scalars, in the order of the file, duplicates included
  std::vector<Value> items;  ///< of a list, or the values of a map in the order of `keys`

  bool is_map() const { return kind == Kind::map; }
  bool is_list() const { return kind == Kind::list; }
  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
};

/// Reads a file that holds one YAML document. Throws bad_input: no such file, a directory, unreadable, empty, syntax
/// error, several documents, a key that is not a scalar, a document that is nested or repeated beyond reason.
Value load_document(const std::filesystem::path& file);

/// Parses the VALUE of `--set KEY=VALUE`; every part of it stands at `where`.
Value parse_override_value(const std::string& text, const std::string& where);

/// What was found, for messages: a number as it is, other text in quotes, "a list", "a map", "nothing".
std::string describe(const Value& value);

}  // namespace common
