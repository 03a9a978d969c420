// Atomic writing under failure: the old file stays, no temporary file stays, the error names path and reason.
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "common/io/immutable_file.hpp"
#include "samples.hpp"

using namespace common_test;

namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// No file of this process may grow beyond `bytes` while this lives; writing past it fails instead of ending it.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit old_{};
  void (*handler_)(int);
};

}  // namespace

TEST_CASE("A file is replaced as a whole, whatever the durability") {
  const Directory directory;
  for (const int interval : {0, 1, 3}) {
    write_atomically(directory / "x", bytes_of("long old content"), {interval});
    write_atomically(directory / "x", bytes_of("new"), {interval});
    CHECK(read_whole_file(directory / "x") == bytes_of("new"));
    write_atomically(directory / "x", {}, {interval});
    CHECK(read_whole_file(directory / "x").empty());
  }
  CHECK(!std::filesystem::exists(directory / "x.tmp"));
}

TEST_CASE("A leftover temporary file of a killed run does no harm") {
  const Directory directory;
  write_atomically(directory / "x.tmp", bytes_of("half of a much longer file"), {});
  write_atomically(directory / "x", bytes_of("new"), {});
  CHECK(read_whole_file(directory / "x") == bytes_of("new"));
}

TEST_CASE("A full disk leaves the old file and no temporary file") {
  const Directory directory;
  const std::filesystem::path path = directory / "x";
  write_atomically(path, bytes_of("old"), {});
  std::filesystem::create_symlink("/dev/full", directory / "x.tmp");
  const Thrown thrown = error_of([&] { write_atomically(path, bytes_of("new"), {}); });
  CHECK(thrown.text == path.string() + ".tmp: cannot write: No space left on device");
  CHECK(thrown.code == ExitCode::io_failure);
  CHECK(read_whole_file(path) == bytes_of("old"));
  CHECK(!std::filesystem::exists(std::filesystem::symlink_status(directory / "x.tmp")));
}

TEST_CASE("A write that fails half way leaves the old file and no temporary file") {
  const Directory directory;
  const std::filesystem::path path = directory / "f.h5";
  Frame old = sample_frame();
  write_frame(path, old, {});
  Frame frame = sample_frame();
  frame.frame = 13;
  Thrown thrown;
  {
    const FileSizeLimit limit(10000);
    thrown = error_of([&] { write_frame(path, frame, {1}); });
  }
  CHECK(thrown.text == path.string() + ".tmp: cannot write: File too large");
  CHECK(thrown.code == ExitCode::io_failure);
  CHECK(frame.payload_hash.empty());
  CHECK(read_frame(path).payload_hash == old.payload_hash);
  CHECK(!std::filesystem::exists(directory / "f.h5.tmp"));
}

TEST_CASE("A place that cannot be written is named with the system's reason") {
  const Directory directory;
  const auto message = [&](const std::filesystem::path& path) {
    const Thrown thrown = error_of([&] { write_atomically(path, bytes_of("new"), {}); });
    CHECK(thrown.code == ExitCode::io_failure);
    return thrown.text;
  };
  const std::filesystem::path nowhere = directory / "none" / "x";
  CHECK(message(nowhere) == nowhere.string() + ".tmp: cannot create: No such file or directory");
  write_atomically(directory / "file", bytes_of("old"), {});
  const std::filesystem::path below_a_file = directory / "file" / "x";
  CHECK(message(below_a_file) == below_a_file.string() + ".tmp: cannot create: Not a directory");
  std::filesystem::create_directory(directory / "folder");
  write_atomically(directory / "folder" / "x", bytes_of("old"), {});
  CHECK(message(directory / "folder") ==
        (directory / "folder").string() + ": cannot rename the temporary file to it: Is a directory");
  CHECK(!std::filesystem::exists(directory / "folder.tmp"));
  if (::geteuid() != 0) {  // nothing is read-only for root
    std::filesystem::permissions(directory / "folder",
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    CHECK(message(directory / "folder" / "x") ==
          (directory / "folder" / "x").string() + ".tmp: cannot create: Permission denied");
    CHECK(read_whole_file(directory / "folder" / "x") == bytes_of("old"));
    std::filesystem::permissions(directory / "folder", std::filesystem::perms::owner_all);
  }
}

TEST_CASE("A file that cannot be read is named with the system's reason") {
  const Directory directory;
  const Thrown missing = error_of([&] { read_frame(directory / "none.h5"); });
  CHECK(missing.text == (directory / "none.h5").string() + ": cannot open: No such file or directory");
  CHECK(missing.code == ExitCode::io_failure);
  const Thrown folder = error_of([&] { read_frame(directory.path()); });
  CHECK(folder.text == directory.path().string() + ": cannot read: Is a directory");
  CHECK(folder.code == ExitCode::io_failure);
}

TEST_CASE("Hashes are those of the XXH3 specification") {
  // xxh128sum of the empty input and of "abc", as published with the reference implementation.
  CHECK(hash_hex({}) == "99aa06d3014798d86001c324468d497f");
  CHECK(hash_hex(bytes_of("abc")) == "06b05ab6733a618578af5f94892f3950");
}

TEST_CASE("A seal fits only the bytes that it was made for") {
  std::vector<std::byte> file = bytes_of("some image");
  CHECK(check_seal(file) == Seal::absent);
  append_seal(file);
  CHECK(check_seal(file) == Seal::intact);
  for (std::size_t i = 0; i < file.size(); ++i) {
    file[i] ^= std::byte{4};
    CHECK(check_seal(file) == (i >= 10 && i < 18 ? Seal::absent : Seal::broken));
    file[i] ^= std::byte{4};
  }
}
