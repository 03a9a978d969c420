// Families of awkward pairs. A pair is a function of its family and its seed.
#pragma once

#include <cstdint>
#include <span>

#include "tests/robustness/geometry/outlines.hpp"

namespace differential {

class Draw;

struct Family {
  const char* name;
  void (*make)(Draw&, OutlinePair&);
};

std::span<const Family> families();

/// Coordinates relative to one of the two, sizes about 0.5 m; one pair in eight is scaled by a power of two between
/// 2^-20 and 2^20. Every outline is fit to be a particle's.
void make_pair(const Family& family, std::uint64_t seed, OutlinePair& pair);

}  // namespace differential
