// Damages copies of frames and splits at random and reads them: each must be refused by name, or read as what was
// written.
//
//   build/release/tests/damage runs/demo/frames/000000.h5 runs/demo/splits/000000.h5 --count 10000 --seed 1
//
// Exit code 1 if a reader says nothing of the file, ends otherwise than by common::Error, or reads something else. A
// crash or a hang ends the program itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <utility>

#include "common/error.hpp"
#include "common/io/frame.hpp"
#include "common/io/immutable_file.hpp"
#include "common/io/split.hpp"

namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<std::byte>;

class Damage {
 public:
  explicit Damage(std::uint64_t seed) : generator_(seed) {}

  std::uint64_t below(std::uint64_t n) { return generator_() % n; }

  static constexpr std::size_t kSealed = 7;  // kinds below that leave a seal, or break it
  static constexpr const char* kKinds[] = {
      "bit flipped",    "bits flipped",     "byte changed",   "truncated",    "zeros in a block",
      "blocks swapped", "noise in a block", "bytes appended", "seal cut off", "seal cut off and bit flipped"};

  void apply(std::size_t kind, Bytes& file) {
    const std::size_t size = file.size();
    const auto flip = [&] { file[below(file.size())] ^= std::byte{1} << below(8); };
    const std::size_t length = 1 + below(std::min<std::size_t>(size / 2, 4096));
    const auto block = [&] { return file.begin() + static_cast<std::ptrdiff_t>(below(size - length)); };
    switch (kind) {
      case 0:
        return flip();
      case 1:
        for (std::uint64_t n = 2 + below(20); n > 0; --n) flip();
        return;
      case 2:
        file[below(size)] = static_cast<std::byte>(below(256));
        return;
      case 3:
        file.resize(below(size));
        return;
      case 4:
        std::fill_n(block(), length, std::byte{0});
        return;
      case 5: {
        const auto first = block(), second = block();
        for (std::size_t i = 0; i < length; ++i) std::swap(first[i], second[i]);
        return;
      }
      case 6:
        std::generate_n(block(), length, [&] { return static_cast<std::byte>(below(256)); });
        return;
      case 7:
        for (std::uint64_t n = 1 + below(100); n > 0; --n) file.push_back(static_cast<std::byte>(below(256)));
        return;
      case 8:
        file.resize(size - common::kSealBytes);
        return;
      default:
        file.resize(size - common::kSealBytes);
        flip();
    }
  }

 private:
  std::mt19937_64 generator_;
};

std::string read(const fs::path& path, bool is_frame) {
  if (is_frame) return common::read_frame(path).payload_hash;
  return common::read_split(path).payload_hash;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Random damage to frames and splits");
  std::vector<std::string> files;
  std::uint64_t count = 1000, seed = 1;
  app.add_option("files", files, "frames (in a folder frames/) and splits")->required();
  app.add_option("--count", count, "damaged copies in all");
  app.add_option("--seed", seed, "of the damage");
  CLI11_PARSE(app, argc, argv);

  const fs::path copy = fs::temp_directory_path() / fmt::format("damaged_{}_{}.h5", seed, ::getpid());
  Damage damage(seed);
  std::map<std::string, std::array<std::uint64_t, 3>> counts;  // refused, as written, unchanged
  std::uint64_t wrong = 0;
  for (std::uint64_t n = 0; n < count; ++n) {
    const fs::path original = files[damage.below(files.size())];
    const bool is_frame = original.parent_path().filename() == "frames";
    const Bytes intact = common::read_whole_file(original);
    Bytes bytes = intact;
    // A file without its seal at its end is tried in a process of its own: slower, so rarer.
    const std::size_t kind = n % 60 < 3 ? Damage::kSealed + n % 60 : damage.below(Damage::kSealed);
    damage.apply(kind, bytes);
    auto& [refused, same, unchanged] = counts[Damage::kKinds[kind]];
    if (bytes == intact) {
      ++unchanged;
      continue;
    }
    common::write_atomically(copy, bytes, {});
    std::string fault;
    try {
      if (read(copy, is_frame) == read(original, is_frame)) {
        ++same;
        if (kind < Damage::kSealed) fault = "was accepted";
      } else {
        fault = "reads as something else";
      }
    } catch (const common::Error& error) {
      ++refused;
      if (!std::strstr(error.what(), copy.filename().c_str())) fault = std::string("is not named: ") + error.what();
    } catch (const std::exception& error) {
      fault = std::string("ends in ") + error.what();
    }
    if (fault.empty()) continue;
    ++wrong;
    fmt::print("WRONG: seed {}, copy {} of {}, {}: {}\n", seed, n, original.string(), Damage::kKinds[kind], fault);
  }
  fs::remove(copy);
  for (const auto& [kind, found] : counts) {
    fmt::print("{}: {} refused, {} read as written, {} unchanged\n", kind, found[0], found[1], found[2]);
  }
  fmt::print("{} copies, {} wrong\n", count, wrong);
  return wrong == 0 ? 0 : 1;
}
