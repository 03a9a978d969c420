#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.hpp"
#include "tests/unit/scratch_folder.hpp"

namespace fuzz {
std::span<const Target> targets() {
  static constexpr std::array kTargets = {
      Target{"scene", scene, 0},         Target{"file_bytes", file_bytes, 0}, Target{"files", files, 48},
      Target{"coupling", coupling, 600}, Target{"overlap", overlap, 120},     Target{"chord", chord, 160},
      Target{"growth", growth, 240},     Target{"serve", serve, 80},
  };
  return kTargets;
}

void wrong(const std::string& what) {
  fmt::print(stderr, "WRONG: {}\n", what);
  std::abort();
}

const std::filesystem::path& scratch() {
  static const scratch::Folder folder;
  return folder.path();
}

std::filesystem::path scratch_file(const std::string& name, Input bytes) {
  const std::filesystem::path path = scratch() / name;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) wrong("cannot write " + path.string());
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written <= 0) wrong("cannot write " + path.string());
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  ::close(file);
  return path;
}

}  // namespace fuzz
