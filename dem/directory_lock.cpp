#include "dem/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>

#include "common/error.hpp"

namespace dem {
namespace {

// The descriptor that the environment names, or -1.
int inherited_descriptor() {
  const char* text = std::getenv("ROCKBREAK_LOCK");
  if (text == nullptr) return -1;
  const std::string_view digits(text);
  int number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc() && end == digits.data() + digits.size() && number >= 0 ? number : -1;
}

bool same_file(int a, int b) {
  struct stat first {
  }, second{};
  return fstat(a, &first) == 0 && fstat(b, &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

}  // namespace

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / ".lock";
  do {
    own_ = open(path.c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0666);
  } while (own_ < 0 && errno == EINTR);
  if (own_ < 0) {
    throw common::io_failure(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  }
  // The driver's lock belongs to its open file, which a descriptor of our own is not.
  const int inherited = inherited_descriptor();
  const bool from_driver = inherited >= 0 && same_file(inherited, own_);
  if (flock(from_driver ? inherited : own_, LOCK_EX | LOCK_NB) == 0) {
    if (from_driver) {
      close(own_);
      own_ = -1;
    }
    return;
  }
  const int reason = errno;
  close(own_);
  if (reason != EWOULDBLOCK) {
    throw common::io_failure(fmt::format("{}: cannot be locked: {}", path.string(), std::strerror(reason)));
  }
  throw common::bad_input(
      fmt::format("{}: another dem or pipeline/run is at work in this directory; wait for it, or name a new directory",
                  directory.string()));
}

DirectoryLock::~DirectoryLock() {
  if (own_ >= 0) close(own_);
}

}  // namespace dem
