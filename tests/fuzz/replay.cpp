// All targets without libFuzzer, in any build: on files, or on the committed inputs and random ones.
//
//   fuzz_replay                               every target: corpus, regressions, and 1000 random inputs each
//   fuzz_replay --random 100000 overlap       one target, more of them
//   fuzz_replay growth build/crash-growth     one input
//
// The random inputs are the same every time. Targets of text and files get changed files of their corpus. An input that
// goes wrong, or takes more than a minute, is left in crash-TARGET in the working directory; exit code other than 0.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/targets.hpp"
#include "tests/robustness/geometry/draw.hpp"

namespace {

constexpr unsigned kSecondsAtMost = 60;

using Bytes = std::vector<std::uint8_t>;
using differential::Draw;

// What a signal handler can reach.
const char* running_name = "";
const Bytes* running = nullptr;

void leave_input(int signal) {
  char name[64] = "crash-";
  std::size_t length = 6;
  for (const char* c = running_name; *c && length < 60; ++c) name[length++] = *c;
  const int file = ::open(name, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  bool told = file >= 0 && running && ::write(file, running->data(), running->size()) >= 0;
  name[length++] = '\n';
  told = told && ::write(STDERR_FILENO, name, length) > 0;
  std::signal(signal, SIG_DFL);
  ::raise(signal);
}

void run(const fuzz::Target& target, const Bytes& input) {
  running = &input;
  ::alarm(kSecondsAtMost);
  target.run(input);
  ::alarm(0);
  running = nullptr;
}

Bytes content_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fuzz::wrong("cannot read " + path.string());
  return Bytes(std::istreambuf_iterator<char>(stream), {});
}

/// The files of a folder by name.
std::vector<Bytes> folder(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> names;
  if (std::filesystem::is_directory(path)) {
    for (const auto& entry : std::filesystem::directory_iterator(path)) names.push_back(entry.path());
  }
  std::sort(names.begin(), names.end());
  std::vector<Bytes> contents;
  for (const auto& name : names) contents.push_back(content_of(name));
  return contents;
}

Bytes random_bytes(Draw& draw, std::size_t most) {
  Bytes bytes(static_cast<std::size_t>(draw.integer(0, static_cast<int>(most))));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(draw.bits());
  return bytes;
}

/// A file with some bytes changed, taken out, repeated, or taken from another file.
Bytes changed(Draw& draw, const std::vector<Bytes>& corpus) {
  const auto pick = [&]() -> const Bytes& { return corpus[draw.bits() % corpus.size()]; };
  const auto place = [&](const Bytes& bytes) { return static_cast<std::ptrdiff_t>(draw.bits() % (bytes.size() + 1)); };
  Bytes bytes = pick();
  for (int changes = draw.integer(1, 4); changes > 0; --changes) {
    const std::ptrdiff_t at = place(bytes);
    const auto piece_of = [&](const Bytes& from) {
      const std::ptrdiff_t first = place(from);
      return Bytes(from.begin() + first,
                   from.begin() + std::min<std::ptrdiff_t>(from.size(), first + draw.integer(1, 40)));
    };
    switch (draw.integer(0, 3)) {
      case 0:
        if (at < std::ssize(bytes)) bytes[at] ^= static_cast<std::uint8_t>(1 << draw.integer(0, 7));
        break;
      case 1:
        bytes.erase(bytes.begin() + at,
                    bytes.begin() + std::min<std::ptrdiff_t>(std::ssize(bytes), at + draw.integer(1, 40)));
        break;
      case 2: {
        const Bytes piece = piece_of(bytes);
        bytes.insert(bytes.begin() + at, piece.begin(), piece.end());
        break;
      }
      default: {
        const Bytes piece = piece_of(pick());
        bytes.insert(bytes.begin() + at, piece.begin(), piece.end());
      }
    }
  }
  return bytes;
}

std::size_t replay(const fuzz::Target& target, const std::filesystem::path& home, int random, std::uint64_t seed) {
  const std::vector<Bytes> corpus = folder(home / "corpus" / target.name);
  const std::vector<Bytes> regressions = folder(home / "regressions" / target.name);
  for (const Bytes& input : regressions) run(target, input);
  for (const Bytes& input : corpus) run(target, input);
  Draw draw(seed);
  if (corpus.empty() && target.random_bytes == 0) return regressions.size();
  for (int k = 0; k < random; ++k) {
    run(target, target.random_bytes > 0 && (corpus.empty() || draw.one_in(2)) ? random_bytes(draw, target.random_bytes)
                                                                              : changed(draw, corpus));
  }
  return regressions.size() + corpus.size();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs the fuzz targets on the committed inputs and on random ones.");
  std::string name;
  std::vector<std::string> files;
  int random = 1000;
  std::uint64_t seed = 1;
  app.add_option("target", name, "one target; none: all");
  app.add_option("files", files, "inputs; none: the committed ones and random ones");
  app.add_option("--random", random, "random inputs of each target");
  app.add_option("--seed", seed, "of the random inputs");
  CLI11_PARSE(app, argc, argv);

  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL, SIGALRM}) std::signal(signal, leave_input);
  bool found = false;
  for (const fuzz::Target& target : fuzz::targets()) {
    if (!name.empty() && name != target.name) continue;
    found = true;
    running_name = target.name;
    if (!files.empty()) {
      for (const std::string& file : files) run(target, content_of(file));
      fmt::print("{}: {} files\n", target.name, files.size());
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    const std::size_t committed = replay(target, ROCKBREAK_FUZZ_DIR, random, seed);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{}: {} committed inputs, {} random ones, {:.1f} s\n", target.name, committed, random, seconds);
    std::fflush(stdout);
  }
  if (!found) fmt::print(stderr, "fuzz_replay: no target \"{}\"\n", name);
  return found ? 0 : 2;
}
