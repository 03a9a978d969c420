// The fuzz targets. Each is a function of bytes that returns whatever the bytes are; what must not happen (a wrong
// answer, an exception that is not common::Error) ends the process by abort(), and the sanitizers watch the rest.
// libfuzzer.cpp makes one fuzzer of each, replay.cpp runs all of them on given or random bytes in any build.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <span>
#include <string>

#include "common/error.hpp"

namespace fuzz {

using Input = std::span<const std::uint8_t>;

void scene(Input input);       ///< YAML of a scene or a laboratory test, its files and overrides
void file_bytes(Input input);  ///< the bytes of a frame or split file
void files(Input input);       ///< frame and split files whose contents were changed, then dem and xfem on what reads
void coupling(Input input);    ///< a frame built from the bytes, solved, split, stepped on
void overlap(Input input);     ///< two convex polygons against the oracles of tests/robustness/geometry
void chord(Input input);       ///< a polygon cut along a chord, and the fragments in an assembly
void growth(Input input);      ///< one particle: outline, mesh, loads, rock, stored cracks
void serve(Input input);       ///< lines of the resident protocols

struct Target {
  const char* name;
  void (*run)(Input);
  /// Bytes of a random input at most; 0: text or files, for which random bytes say nothing.
  std::size_t random_bytes;
};
std::span<const Target> targets();

/// Something that must not happen: says what, and aborts.
[[noreturn]] void wrong(const std::string& what);

inline void require(bool holds, const char* what) {
  if (!holds) wrong(what);
}

/// True; or false if `action` refuses with common::Error, which needs a message.
template <class Action>
bool unless_refused(const Action& action) {
  try {
    action();
    return true;
  } catch (const common::Error& error) {
    require(!std::string(error.what()).empty(), "an error without a message");
    return false;
  } catch (const std::exception& error) {
    wrong(std::string("an exception that is no common::Error: ") + error.what());
  }
}

/// Runs what must not be refused.
template <class Action>
void must(const char* what, const Action& action) {
  try {
    action();
  } catch (const std::exception& error) {
    wrong(std::string(what) + ": " + error.what());
  }
}

/// A folder of this process, removed at its end.
const std::filesystem::path& scratch();

/// A file in `scratch` with these bytes.
std::filesystem::path scratch_file(const std::string& name, Input bytes);

}  // namespace fuzz
