#include "common/config/specification.hpp"

#include <cmath>
#include <set>
#include <span>

#include "common/config/document.hpp"
#include "common/config/suggestion.hpp"
#include "common/config/values.hpp"
#include "common/error.hpp"
#include "common/io/immutable_file.hpp"

namespace common {
namespace {

std::string with_unit(const std::string& expected, const std::string& unit) {
  return unit == "-" ? expected : expected + " [" + unit + "]";
}

double read_number(const Value& value, const Range& range, const Key& key) {
  const std::optional<double> number = value.is_scalar() && !value.quoted ? parse_number(value.text) : std::nullopt;
  if (!number || !contains(range, *number)) refuse(value, key.path, with_unit(key.expected, key.unit));
  return *number;
}

bool is_word(const Value& value, std::string_view word) {
  return value.is_scalar() && !value.quoted && value.text == word;
}

// Last name of a dotted path, and the path of a name in a section.
std::string name_of(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}
std::string below(const std::string& section, const std::string& name) {
  return section.empty() ? name : section + '.' + name;
}

}  // namespace

void refuse(const Value& value, const std::string& path, const std::string& expected) {
  throw bad_input(value.where + ": " + path + ": found " + describe(value) + ", expected " + expected);
}

void Specification::number(const std::string& path, double& value, Range range, const std::string& unit, UsedBy used_by,
                           const std::string& description) {
  const Key key{path, unit, description, describe(range, "a number"), used_by};
  custom(
      key, [=, &value](const Value& given) { value = read_number(given, range, key); },
      [&value](UsedBy) { return print_number(value); });
}

void Specification::optional_number(const std::string& path, std::optional<double>& value, Range range,
                                    const std::string& unit, UsedBy used_by, const std::string& description) {
  const Key key{path, unit, description, "auto or " + describe(range, "a number"), used_by};
  custom(
      key,
      [=, &value](const Value& given) {
        value = is_word(given, "auto") ? std::nullopt : std::optional(read_number(given, range, key));
      },
      [&value](UsedBy) { return value ? print_number(*value) : "auto"; });
}

void Specification::vector(const std::string& path, Vec2& value, const std::string& unit, UsedBy used_by,
                           const std::string& description) {
  const Key key{path, unit, description, "a list of two numbers", used_by};
  custom(
      key,
      [=, &value](const Value& given) {
        if (!given.is_list() || given.items.size() != 2) refuse(given, path, with_unit(key.expected, unit));
        const Key component{path, unit, description, "a number", used_by};
        value = Vec2(read_number(given.items[0], kAny, component), read_number(given.items[1], kAny, component));
      },
      [&value](UsedBy) {
        std::string text = "[";
        text += print_number(value.x());
        text += ", ";
        text += print_number(value.y());
        return text + "]";
      });
}

void Specification::integer(const std::string& path, int& value, int low, int high, const std::string& unit,
                            UsedBy used_by, const std::string& description) {
  const Range range{static_cast<double>(low), static_cast<double>(high)};
  const Key key{path, unit, description, describe(range, "an integer"), used_by};
  custom(
      key,
      [=, &value](const Value& given) {
        const auto number = given.is_scalar() && !given.quoted ? parse_integer(given.text) : std::nullopt;
        if (!number || *number < low || *number > high) {
          refuse(given, key.path, with_unit(key.expected, unit) + (number ? "" : ", written in digits only"));
        }
        value = static_cast<int>(*number);
      },
      [&value](UsedBy) { return std::to_string(value); });
}

void Specification::flag(const std::string& path, bool& value, UsedBy used_by, const std::string& description) {
  custom(
      {path, "-", description, "true or false", used_by},
      [path, &value](const Value& given) {
        if (!is_word(given, "true") && !is_word(given, "false")) refuse(given, path, "true or false");
        value = given.text == "true";
      },
      [&value](UsedBy) { return value ? "true" : "false"; });
}

void Specification::text(const std::string& path, std::string& value, const std::string& expected, UsedBy used_by,
                         const std::string& description) {
  custom(
      {path, "-", description, expected, used_by},
      [=, &value](const Value& given) {
        if (!given.is_scalar() && !given.is_null()) refuse(given, path, expected);
        value = given.text;
      },
      [&value](UsedBy) { return in_quotes(value); });
}

void Specification::named(const std::string& path, const std::vector<std::string>& names, std::function<void(int)> set,
                          std::function<int()> get, UsedBy used_by, const std::string& description) {
  const std::string expected = "one of " + join(names);
  custom(
      {path, "-", description, expected, used_by},
      [=](const Value& given) {
        for (std::size_t i = 0; i < names.size(); ++i) {
          if (given.is_scalar() && given.text == names[i]) return set(static_cast<int>(i));
        }
        const std::string near = given.is_scalar() ? nearest_name(given.text, names) : "";
        refuse(given, path, expected + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
      },
      [=](UsedBy) { return names[static_cast<std::size_t>(get())]; });
}

void Specification::custom(Key key, Reader read, Printer print) {
  bindings_.push_back({std::move(key), std::move(read), std::move(print)});
}

void Specification::section_file(const std::string& path, const std::filesystem::path& folder,
                                 const std::string& description) {
  const std::string expected = "the name of a file";
  custom(
      {path, "-", description, expected, UsedBy::neither},
      [=](const Value& value) {
        if (!value.is_null() && !value.is_scalar()) refuse(value, path, expected);
      },
      [](UsedBy) { return in_quotes(""); });
  section_files_[path] = folder;
}

void Specification::shorthand(const std::string& section, std::function<Value(const Value&)> expand) {
  shorthands_[section] = std::move(expand);
}

const Specification::Binding* Specification::find(const std::string& path) const {
  for (const Binding& binding : bindings_) {
    if (binding.key.path == path) return &binding;
  }
  return nullptr;
}

std::vector<std::string> Specification::names_in(const std::string& section) const {
  std::vector<std::string> names;
  const std::string prefix = section.empty() ? "" : section + '.';
  for (const Binding& binding : bindings_) {
    const std::string& path = binding.key.path;
    if (path.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string name = path.substr(prefix.size(), path.find('.', prefix.size()) - prefix.size());
    if (names.empty() || names.back() != name) names.push_back(name);
  }
  return names;
}

std::string Specification::unknown_key(const std::string& name, const std::string& section) const {
  const std::vector<std::string> names = names_in(section);
  std::string text = "unknown key " + in_quotes(name) + (section.empty() ? "" : " in " + section);
  if (names.empty()) return text + "; expected a value of " + section + ", which has no keys below it";
  if (find(below(section, name))) {  // a dotted name in a file
    return text + "; expected it in its section, as in " + name.substr(0, name.find('.')) + ": {...}";
  }
  if (nearest_name(name, names).empty()) {
    for (const Binding& binding : bindings_) {
      if (name_of(binding.key.path) == name) return text + "; did you mean \"" + binding.key.path + "\"?";
    }
  }
  return text + suggestion(name, names, "expected one of ");
}

void Specification::walk(const Value& value, const std::string& path) {
  if (const Binding* binding = find(path)) {
    given_[path] = value.where;
    try {
      binding->read(value);
      if (section_files_.contains(path) && !value.text.empty()) walk_file(value, path);
    } catch (const Error& error) {
      errors_.emplace_back(error.what());
    }
    return;
  }
  const auto expand = shorthands_.find(path);
  if (expand != shorthands_.end() && !value.is_map() && !value.is_null()) {
    return walk(expand->second(value), path);
  }
  if (value.is_null() && !path.empty()) return;  // a section whose keys are all commented out
  if (!value.is_map()) {
    errors_.push_back(value.where + ": " + (path.empty() ? "" : path + ": ") + "found " + describe(value) +
                      ", expected a map of keys (" + join(names_in(path)) + ")");
    return;
  }
  std::map<std::string, std::string> seen;
  std::vector<std::size_t> order;  // a file of the section first, so that the keys beside it override it
  for (const bool files : {true, false}) {
    for (std::size_t i = 0; i < value.keys.size(); ++i)
      if (section_files_.contains(below(path, value.keys[i].text)) == files) order.push_back(i);
  }
  for (const std::size_t i : order) {
    const Value& key = value.keys[i];
    const auto [first, is_new] = seen.emplace(key.text, key.where);
    const std::string child = below(path, key.text);
    if (!is_new) {
      errors_.push_back(key.where + ": duplicate key " + in_quotes(key.text) + (path.empty() ? "" : " in " + path) +
                        ", first given at " + first->second + "; expected each key once");
    } else if (key.text.find('.') != std::string::npos || (!find(child) && names_in(child).empty())) {
      errors_.push_back(key.where + ": " + unknown_key(key.text, path));
    } else {
      walk(value.items[i], child);
    }
  }
}

void Specification::walk_file(const Value& value, const std::string& path) {
  if (inside_file_) refuse(value, path, "the keys themselves: this file is named by another one");
  const bool overridden = value.where.starts_with("--set ");
  const std::filesystem::path folder = overridden ? std::filesystem::current_path() : section_files_.at(path);
  const std::filesystem::path file = (std::filesystem::absolute(folder) / value.text).lexically_normal();
  Value keys;
  try {
    keys = load_document(file);
  } catch (const Error& error) {
    throw bad_input(value.where + ": " + path + ": " + error.what());
  }
  struct Inside {
    explicit Inside(bool& flag) : inside(flag) { inside = true; }
    ~Inside() { inside = false; }  // also when an exception passes
    bool& inside;
  } const guard(inside_file_);
  walk(keys, path.substr(0, path.rfind('.')));
}

void Specification::read(const Value& document) {
  document_ = document.where;
  walk(document, "");
}

void Specification::set(const std::string& assignment) {
  const std::string place = "--set " + assignment;
  const std::size_t equal = assignment.find('=');
  if (equal == std::string::npos || equal == 0) {
    errors_.push_back(place + ": expected KEY=VALUE, for example --set seed=2");
    return;
  }
  const std::string path = assignment.substr(0, equal);
  // Name by name, so that the first unknown one is reported in its section.
  std::string section;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    const std::string name = path.substr(start, dot - start);
    const std::string child = below(section, name);
    if (!find(child) && (name.empty() || names_in(child).empty())) {
      errors_.push_back(place + ": " + unknown_key(name, section));
      return;
    }
    section = child;
    start = dot + 1;
  }
  try {
    walk(parse_override_value(assignment.substr(equal + 1), place), path);
  } catch (const Error& error) {
    errors_.emplace_back(error.what());
  }
}

void Specification::set(const Overrides& assignments) {
  const auto names_file = [this](const std::string& assignment) {
    return section_files_.contains(assignment.substr(0, assignment.find('=')));
  };
  for (const bool files : {true, false}) {
    for (const std::string& assignment : assignments)
      if (names_file(assignment) == files) set(assignment);
  }
}

void Specification::fail(const std::vector<std::string>& paths, const std::string& message) {
  std::string place = document_;
  for (const std::string& path : paths) {
    if (given(path)) {
      place = where(path);
      break;
    }
  }
  errors_.push_back(place + ": " + message);
}

void Specification::finish() const {
  if (errors_.empty()) return;
  std::string text;
  for (const std::string& error : errors_) text += (text.empty() ? "" : "\n") + error;
  throw bad_input(text);
}

std::string Specification::where(const std::string& path) const {
  const auto place = given_.find(path);
  return place == given_.end() ? "" : place->second;
}

std::vector<Key> Specification::keys() const {
  std::vector<Key> keys;
  for (const Binding& binding : bindings_) keys.push_back(binding.key);
  return keys;
}

std::string Specification::to_yaml(const std::string& title) const {
  std::string text = title;
  std::set<std::string> opened;
  for (const Binding& binding : bindings_) {
    const std::string& path = binding.key.path;
    std::string indent;
    for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1)) {
      const std::string section = path.substr(0, dot);
      if (opened.insert(section).second) text += indent + name_of(section) + ":\n";
      indent += "  ";
    }
    text += indent + name_of(path) + ": " + binding.print(UsedBy::neither) + "  # [" + binding.key.unit + "] " +
            binding.key.description + "\n";
  }
  return text;
}

void Specification::only_with(const bool& effect, const std::string& path) {
  effects_[path] = &effect;
}

bool Specification::has_effect(const std::string& path) const {
  for (std::size_t end = path.size(); end != std::string::npos; end = end == 0 ? end : path.rfind('.', end - 1)) {
    const auto effect = effects_.find(path.substr(0, end));
    if (effect != effects_.end() && !*effect->second) return false;
    if (end == 0) break;
  }
  return true;
}

std::string Specification::hash(UsedBy executable) const {
  std::string text;
  for (const Binding& binding : bindings_) {
    if (binding.key.used_by != executable && binding.key.used_by != UsedBy::both) continue;
    if (!has_effect(binding.key.path)) continue;
    text += binding.key.path + ": " + binding.print(executable) + '\n';
  }
  return hash_hex(std::as_bytes(std::span(text)));
}

}  // namespace common
