#include "common/io/provenance.hpp"

#include <fstream>

#include "build_flags.hpp"
#include "git_version.hpp"

namespace common {
namespace {

std::string host_cpu() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "gcc " __VERSION__;
#endif
}

}  // namespace

const std::map<std::string, std::string>& provenance() {
  static const std::map<std::string, std::string> values = {
      {"git", kGitVersion}, {"compiler", compiler()}, {"flags", kBuildFlags}, {"host_cpu", host_cpu()}};
  return values;
}

}  // namespace common
