// One specification of keys: it validates a YAML file, fills in defaults, prints the resolved configuration and
// documents itself. A key is bound to a member of a plain struct, whose initializer is the default.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace common {

struct Value;

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

/// The keys of a configuration, each bound to a member of one object, which must outlive the specification.
class Specification {
 public:
  using Reader = std::function<void(const Value&)>;
  /// Canonical text of the value as YAML; `executable` is `neither` for printing, else the one whose hash is made (only
  /// a key that both use in part looks at it).
  using Printer = std::function<std::string(UsedBy executable)>;

  void number(const std::string& path, double& value, Range range, const std::string& unit, UsedBy used_by,
              const std::string& description);
  /// `auto` or a number.
  void optional_number(const std::string& path, std::optional<double>& value, Range range, const std::string& unit,
                       UsedBy used_by, const std::string& description);
  /// A list of two numbers.
  void vector(const std::string& path, Vec2& value, const std::string& unit, UsedBy used_by,
              const std::string& description);
  void integer(const std::string& path, int& value, int low, int high, const std::string& unit, UsedBy used_by,
               const std::string& description);
  void flag(const std::string& path, bool& value, UsedBy used_by, const std::string& description);
  void text(const std::string& path, std::string& value, const std::string& expected, UsedBy used_by,
            const std::string& description);
  /// The enumerators count from 0 in the order of `names`.
  template <class Enum>
  void choice(const std::string& path, Enum& value, const std::vector<std::string>& names, UsedBy used_by,
              const std::string& description) {
    named(
        path, names, [&value](int index) { value = static_cast<Enum>(index); },
        [&value] { return static_cast<int>(value); }, used_by, description);
  }
  void named(const std::string& path, const std::vector<std::string>& names, std::function<void(int)> set,
             std::function<int()> get, UsedBy used_by, const std::string& description);
  /// Any other kind of key. `read` throws bad_input for a value that it does not take (see `refuse`).
  void custom(Key key, Reader read, Printer print);
  /// A key that names a file with keys of the section in which it stands, relative to `folder` (in --set: to the
  /// working directory). The keys that stand beside it go before the file's, wherever they stand; it prints as "" since
  /// they are all resolved.
  void section_file(const std::string& path, const std::filesystem::path& folder, const std::string& description);
  /// The key, or all keys of the section, mean something only while `effect` is true: the hash leaves them out
  /// otherwise.
  void only_with(const bool& effect, const std::string& path);
  /// A section that may be given as something else than a map: `expand` turns that into the map that it stands for.
  void shorthand(const std::string& section, std::function<Value(const Value&)> expand);

  /// Reads a document into the bound members; errors are collected until `finish`.
  void read(const Value& document);
  /// Applies `path=value`, the same way.
  void set(const std::string& assignment);
  /// Applies them in order, but files of sections (see section_file) before all others.
  void set(const Overrides& assignments);
  /// An error found between keys, at the place where the first of `paths` that was given stands.
  void fail(const std::vector<std::string>& paths, const std::string& message);
  /// Throws bad_input with all errors, one in a line, in the order in which they were found; nothing if there is none.
  void finish() const;

  /// Where the key was given last (FILE:LINE:COLUMN or --set ...); empty if it was not.
  std::string where(const std::string& path) const;
  bool given(const std::string& path) const { return !where(path).empty(); }

  std::vector<Key> keys() const;
  /// `title` lines, then every key with its value, unit and description.
  std::string to_yaml(const std::string& title) const;
  /// Hex XXH3-128 over the `path: value` lines of the keys that the executable uses and whose effect exists.
  std::string hash(UsedBy executable) const;

 private:
  struct Binding {
    Key key;
    Reader read;
    Printer print;
  };

  void walk(const Value& value, const std::string& path);
  void walk_file(const Value& value, const std::string& path);
  const Binding* find(const std::string& path) const;
  bool has_effect(const std::string& path) const;
  std::vector<std::string> names_in(const std::string& section) const;
  std::string unknown_key(const std::string& name, const std::string& section) const;

  std::vector<Binding> bindings_;
  std::map<std::string, std::function<Value(const Value&)>> shorthands_;
  std::map<std::string, const bool*> effects_;                  ///< key or section to the effect that it belongs to
  std::map<std::string, std::filesystem::path> section_files_;  ///< path to folder
  bool inside_file_ = false;                                    ///< of a section
  std::map<std::string, std::string> given_;                    ///< path to place
  std::string document_;  ///< place of the document, for errors between keys that are not given
  std::vector<std::string> errors_;
};

/// The error for a value that a key does not take: `WHERE: PATH: found X, expected Y`.
[[noreturn]] void refuse(const Value& value, const std::string& path, const std::string& expected);

}  // namespace common
