// One run in a directory at a time: an flock on DIR/.lock, which the kernel gives back when its last holder ends.
#pragma once

#include <filesystem>

namespace dem {

/// Holds the lock of a run directory, which must exist, as long as it lives. A driver that holds it already passes its
/// descriptor on: its number stands in the environment as ROCKBREAK_LOCK, and counts if it is one of this directory's
/// .lock. Throws bad_input if somebody else holds the lock, io_failure if it cannot be asked for.
class DirectoryLock {
 public:
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int own_ = -1;  ///< -1: the driver's
};

}  // namespace dem
