// What stands in a test's files, and what an error says of them.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "common/error.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace scratch {

inline std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The message of the bad_input that `action` throws, without the folder's name; "no error" if it throws none.
template <class Action>
std::string message_of(const Folder& folder, Action&& action) {
  try {
    action();
  } catch (const common::Error& error) {
    if (error.code() != common::ExitCode::bad_input) return "wrong exit code";
    std::string text = error.what();
    const std::string prefix = folder.path().string() + '/';
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "no error";
}

}  // namespace scratch
