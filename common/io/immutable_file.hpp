// Immutable files: an HDF5 image made in memory, written to NAME.tmp, every return value checked, then renamed.
// Killed at any moment, the directory holds the old file or the new one, never half of one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace common {

/// fsync after every file, after every n-th, or never (`output.durability: every | N | none`).
struct Durability {
  int interval = 0;  ///< 0: none, 1: every file, n: every n-th
};

/// For the few files that everything else hangs on.
inline constexpr Durability kDurable{1};

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

/// Reads a whole file. Throws io_failure naming the path and the system's reason.
std::vector<std::byte> read_whole_file(const std::filesystem::path& path);

/// Hex XXH3-128 of some bytes.
std::string hash_hex(std::span<const std::byte> bytes);

/// Two hexadecimal digits for each byte.
std::string hex(std::span<const std::byte> bytes);

/// The seal is kSealBytes bytes after the end of an image: the letters "RBSEAL01" and the image's XXH3-128 (canonical,
/// big-endian). HDF5 ignores what follows its own end, so a sealed file is a plain HDF5 file for every other reader;
/// ours sees any damage before HDF5 parses it.
inline constexpr std::size_t kSealBytes = 24;
void append_seal(std::vector<std::byte>& image);

enum class Seal { absent, intact, broken };
/// Whether `file` ends with a seal, and whether that fits the bytes before it.
Seal check_seal(std::span<const std::byte> file);

}  // namespace common
