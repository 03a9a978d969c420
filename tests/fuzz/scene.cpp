#include "common/config/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "common/config/lab_test.hpp"
#include "dem/explain.hpp"
#include "tests/fuzz/targets.hpp"
#include "xfem/explain.hpp"

namespace fuzz {
namespace {

constexpr std::string_view kMark = "\n%% ";

struct Case {
  bool laboratory = false;
  std::filesystem::path file;
  common::Overrides overrides;
};

Input bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The text up to the first line "%% NAME" is the scene, or the laboratory test if a section `lab` follows; section
/// `set` has an override in each line, and sections of these names are files beside it.
Case unpacked(std::string_view text) {
  static constexpr std::array<std::string_view, 5> kFiles = {"outlines.csv", "outlines.yaml", "grading.csv",
                                                             "grading.yaml", "rock.yaml"};
  for (const std::string_view name : kFiles) std::filesystem::remove(scratch() / name);
  Case found;
  const std::size_t end = std::min(text.find(kMark), text.size());
  found.file = scratch_file("case.yaml", bytes_of(text.substr(0, end)));
  for (std::size_t at = end; at < text.size();) {
    at += kMark.size();
    const std::size_t next = std::min(text.find(kMark, at), text.size());
    const std::size_t line = std::min(text.find('\n', at), next);
    const std::string_view name = text.substr(at, line - at);
    std::string_view body = text.substr(std::min(line + 1, next), next - std::min(line + 1, next));
    if (name == "lab") found.laboratory = true;
    if (std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end()) scratch_file(std::string(name), bytes_of(body));
    while (name == "set" && !body.empty()) {
      const std::size_t stop = std::min(body.find('\n'), body.size());
      found.overrides.emplace_back(body.substr(0, stop));
      body.remove_prefix(std::min(stop + 1, body.size()));
    }
    at = next;
  }
  return found;
}

/// The resolved text is a case of its own: it reads, is resolved to itself and stands for the same configuration.
template <class Read, class Hash>
void check_resolved(const std::string& resolved, const Read& read, const Hash& hash, const std::string& hash_before) {
  const std::filesystem::path path = scratch_file("resolved.yaml", bytes_of(resolved));
  try {
    const auto again = read(path);
    if (common::to_yaml(again) != resolved) wrong("the resolved text resolves to another:\n" + resolved);
    if (hash(again) != hash_before) wrong("the resolved text has another hash:\n" + resolved);
  } catch (const std::exception& error) {
    wrong(fmt::format("the resolved text is refused: {}\n{}", error.what(), resolved));
  }
}

}  // namespace

void scene(Input input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  // Files without an end are the user's own doing.
  if (text.find("/dev") != text.npos || text.find("/proc") != text.npos) return;
  const Case given = unpacked(text);
  if (given.laboratory) {
    common::LabTest test;
    if (!unless_refused([&] { test = common::read_lab_test(given.file, given.overrides); })) return;
    check_resolved(
        common::to_yaml(test), [](const auto& path) { return common::read_lab_test(path); },
        [](const common::LabTest& t) { return common::config_hash(t); }, common::config_hash(test));
    return;
  }
  common::Scene read;
  if (!unless_refused([&] { read = common::read_scene(given.file, given.overrides); })) return;
  const auto hashes = [](const common::Scene& s) {
    return common::config_hash(s, common::UsedBy::dem) + common::config_hash(s, common::UsedBy::xfem);
  };
  check_resolved(
      common::to_yaml(read), [](const auto& path) { return common::read_scene(path); }, hashes, hashes(read));
  unless_refused([&] { dem::explain(read); });
  unless_refused([&] { xfem::explain(read); });
}

}  // namespace fuzz
