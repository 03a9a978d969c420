#include "common/config/document.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/config/values.hpp"
#include "common/error.hpp"

namespace common {
namespace {

// An alias may repeat its anchor, or contain itself: bounds in place of a stack overflow.
constexpr int kDeepest = 32;
constexpr int kMostValues = 1'000'000;

// Where the parts of a document stand: places in a file, or one place for all of an override.
struct Source {
  std::string name;
  bool is_file = true;

  std::string place(const YAML::Mark& mark) const {
    if (!is_file || mark.is_null()) return name;
    return name + ':' + std::to_string(mark.line + 1) + ':' + std::to_string(mark.column + 1);
  }
};

class Converter {
 public:
  explicit Converter(const Source& source) : source_(source) {}

  Value convert(const YAML::Node& node, int depth) {
    Value value;
    value.where = source_.place(node.Mark());
    if (depth > kDeepest || ++count_ > kMostValues) {
      throw bad_input(value.where + ": the document is nested or repeated too often, expected at most " +
                      std::to_string(kDeepest) + " levels");
    }
    switch (node.Type()) {
      case YAML::NodeType::Undefined:
      case YAML::NodeType::Null:
        break;
      case YAML::NodeType::Scalar:
        value.kind = Value::Kind::scalar;
        value.text = node.Scalar();
        value.quoted = node.Tag() == "!";  // yaml-cpp's mark of a quoted scalar; plain ones have "?"
        break;
      case YAML::NodeType::Sequence:
        value.kind = Value::Kind::list;
        for (const auto& item : node) value.items.push_back(convert(item, depth + 1));
        break;
      case YAML::NodeType::Map:
        value.kind = Value::Kind::map;
        for (const auto& entry : node) {
          value.keys.push_back(convert(entry.first, depth + 1));
          const Value& key = value.keys.back();
          if (!key.is_scalar()) throw bad_input(key.where + ": found " + describe(key) + " as a key, expected a name");
          value.items.push_back(convert(entry.second, depth + 1));
          if (value.items.back().is_null()) value.items.back().where = key.where;  // nothing has no place of its own
        }
        break;
    }
    return value;
  }

 private:
  const Source& source_;
  int count_ = 0;
};

// Where documents start. YAML::LoadAll never ends over text after which each document begins where the last one did.
class DocumentStarts : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> starts;

  void OnDocumentStart(const YAML::Mark& mark) override { starts.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// Places of the first two documents, as far as there are any.
std::vector<YAML::Mark> starts_of_documents(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts handler;
  while (handler.starts.size() < 2 && parser.HandleNextDocument(handler)) {
  }
  return handler.starts;
}

std::string line_of(const std::string& text, int number) {
  std::istringstream lines(text);
  std::string line;
  for (int i = 0; i <= number && std::getline(lines, line); ++i) {
  }
  return line;
}

Value parse(const std::string& text, const Source& source) {
  try {
    const std::vector<YAML::Mark> starts = starts_of_documents(text);
    if (starts.size() > 1) throw bad_input(source.place(starts[1]) + ": found a second YAML document, expected one");
    if (starts.empty()) {
      Value nothing;
      nothing.where = source.name;
      return nothing;
    }
    return Converter(source).convert(YAML::Load(text), 0);
  } catch (const YAML::Exception& error) {
    // yaml-cpp reports most tabs as something else, further on in the line.
    const std::string line = line_of(text, error.mark.line);
    const std::size_t tab = line.substr(0, line.find_first_not_of(" \t")).find('\t');
    if (tab != std::string::npos) {
      YAML::Mark mark = error.mark;
      mark.column = static_cast<int>(tab);
      throw bad_input(source.place(mark) + ": syntax error: found a tab in the indentation, expected spaces");
    }
    throw bad_input(source.place(error.mark) + ": syntax error: " + error.msg + ", expected valid YAML");
  }
}

}  // namespace

Value load_document(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code status_error;
  const std::filesystem::file_status status = std::filesystem::status(file, status_error);
  if (status.type() == std::filesystem::file_type::not_found) throw bad_input(name + ": the file does not exist");
  if (status.type() == std::filesystem::file_type::directory) {
    throw bad_input(name + ": found a directory, expected a YAML file");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "read error";
    // An empty file makes rdbuf() fail as well; that one is reported below.
    if (status_error || !std::filesystem::is_regular_file(status) || std::filesystem::file_size(file) > 0) {
      throw bad_input(name + ": the file cannot be read: " + reason);
    }
  }
  Value document = parse(text.str(), {name, true});
  if (document.is_null()) throw bad_input(name + ": the file is empty, expected YAML with at least one key");
  return document;
}

Value parse_override_value(const std::string& text, const std::string& where) {
  return parse(text, {where, false});
}

std::string describe(const Value& value) {
  switch (value.kind) {
    case Value::Kind::null:
      return "nothing";
    case Value::Kind::list:
      return "a list";
    case Value::Kind::map:
      return "a map";
    case Value::Kind::scalar:
      break;
  }
  constexpr std::size_t kLongest = 60;
  const std::string text = value.text.size() > kLongest ? value.text.substr(0, kLongest) + "..." : value.text;
  if (value.quoted) return "the quoted text " + in_quotes(text);
  return looks_like_number(text) ? text : in_quotes(text);
}

}  // namespace common
