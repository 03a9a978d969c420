// A small generator: every pair has a seed of its own, and seeding common::Random costs more than a pair does.
#pragma once

#include <cmath>
#include <cstdint>

#include "common/geometry/vec2.hpp"

namespace differential {

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [low, high]; biased by 2^-32 at most.
  int integer(int low, int high) { return low + static_cast<int>((bits() >> 32) * (high - low + 1) >> 32); }
  bool one_in(int n) { return integer(1, n) == 1; }
  double sign() { return one_in(2) ? 1 : -1; }
  /// Magnitudes between 2^low and 2^high, every binary order equally likely.
  double magnitude(int low, int high) { return std::ldexp(uniform(1, 2), integer(low, high - 1)); }
  common::Vec2 direction() {
    const common::SinCos at = common::sin_cos(uniform(0, 6.283185307179586));
    return {at.cos, at.sin};
  }

 private:
  std::uint64_t state_;
};

}  // namespace differential
