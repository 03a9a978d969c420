#include "common/io/immutable_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "common/error.hpp"

namespace common {
namespace {

constexpr char kSealMagic[] = "RBSEAL01";
constexpr std::size_t kMagicBytes = sizeof(kSealMagic) - 1;
static_assert(kMagicBytes + sizeof(XXH128_canonical_t) == kSealBytes);

XXH128_canonical_t hash_of(std::span<const std::byte> bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  return canonical;
}

Error failure(const std::filesystem::path& path, const std::string& what, int reason) {
  return io_failure(path.string() + ": cannot " + what + ": " + std::generic_category().message(reason));
}

/// A file descriptor that closes itself; `close` reports what closing found.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) {
    do {
      number_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    } while (number_ < 0 && errno == EINTR);
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  /// Not repeated after EINTR: Linux has released the descriptor then.
  int close() {
    const int result = ::close(number_);
    number_ = -1;
    return result < 0 && errno != EINTR ? -1 : 0;
  }

 private:
  int number_;
};

int sync(int descriptor) {
  int result = 0;
  do {
    result = ::fsync(descriptor);
  } while (result < 0 && errno == EINTR);
  return result;
}

void write_all(const Descriptor& file, const std::filesystem::path& path, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw failure(path, "write", errno);
    if (written == 0) throw failure(path, "write", ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void write_temporary(const std::filesystem::path& temporary, std::span<const std::byte> image, bool durable) {
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.number() < 0) throw failure(temporary, "create", errno);
  write_all(file, temporary, image);
  if (durable && sync(file.number()) < 0) throw failure(temporary, "bring to the disk", errno);
  if (file.close() < 0) throw failure(temporary, "close", errno);
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::span<const std::byte> image, Durability durability) {
  static std::atomic<std::uint64_t> files_written{0};
  const bool durable =
      durability.interval > 0 && ++files_written % static_cast<std::uint64_t>(durability.interval) == 0;

  std::filesystem::path temporary = path;
  temporary += ".tmp";
  try {
    write_temporary(temporary, image, durable);
    if (::rename(temporary.c_str(), path.c_str()) < 0) throw failure(path, "rename the temporary file to it", errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  if (durable) {
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    Descriptor directory(parent, O_RDONLY | O_DIRECTORY);
    if (directory.number() < 0) throw failure(parent, "open", errno);
    if (sync(directory.number()) < 0) throw failure(parent, "bring to the disk", errno);
  }
}

std::vector<std::byte> read_whole_file(const std::filesystem::path& path) {
  Descriptor file(path, O_RDONLY);
  if (file.number() < 0) throw failure(path, "open", errno);
  struct stat status {};
  if (::fstat(file.number(), &status) < 0) throw failure(path, "open", errno);
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  std::size_t filled = 0;
  for (;;) {
    // One byte more than expected, so that the end is seen even if the file has grown.
    if (filled == bytes.size()) bytes.resize(filled + (filled == 0 ? 4096 : 1));
    const ssize_t got = ::read(file.number(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw failure(path, "read", errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

std::string hex(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : bytes) {
    text += kDigits[std::to_integer<unsigned>(byte) >> 4];
    text += kDigits[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

std::string hash_hex(std::span<const std::byte> bytes) {
  const XXH128_canonical_t hash = hash_of(bytes);
  return hex(std::as_bytes(std::span(hash.digest)));
}

void append_seal(std::vector<std::byte>& image) {
  const XXH128_canonical_t hash = hash_of(image);
  const auto magic = std::as_bytes(std::span(kSealMagic, kMagicBytes));
  const auto digest = std::as_bytes(std::span(hash.digest));
  image.insert(image.end(), magic.begin(), magic.end());
  image.insert(image.end(), digest.begin(), digest.end());
}

Seal check_seal(std::span<const std::byte> file) {
  if (file.size() < kSealBytes) return Seal::absent;
  const auto seal = file.last(kSealBytes);
  if (std::memcmp(seal.data(), kSealMagic, kMagicBytes) != 0) return Seal::absent;
  const XXH128_canonical_t hash = hash_of(file.first(file.size() - kSealBytes));
  return std::memcmp(seal.data() + kMagicBytes, hash.digest, sizeof(hash.digest)) == 0 ? Seal::intact : Seal::broken;
}

}  // namespace common
