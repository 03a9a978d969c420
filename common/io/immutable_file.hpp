// Immutable files: an HDF5 image made in memory, written to NAME.tmp, every return value checked, then renamed.
// Killed at any moment, the directory holds the old file or the new one, never half of one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace common {

/// fsync after every file, after every n-th, or never (`output.durability: every | N | none`).
struct Durability {
  int interval = 0;  ///< 0: none, 1: every file, n: every n-th
};

/// What the ledger keeps of a written file.
struct WrittenFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::string payload_hash;  ///< hex XXH3-128 of the payload (INTERFACES: Identity)
  std::string file_hash;     ///< hex XXH3-128 of the whole file
};

/// Writes `image` to `path` by temporary file and rename. Throws io_failure naming the path and the system's reason;
/// a failed write removes its temporary file.
void write_atomically(const std::filesystem::path& path, std::span<const std::byte> image, Durability durability);

/// Hex XXH3-128 of some bytes.
std::string hash_hex(std::span<const std::byte> bytes);

}  // namespace common
