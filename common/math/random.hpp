// A seeded generator that gives the same numbers on every platform.
// std::mt19937_64 is fixed by the C++ standard; the standard's distributions are not, so they are not used.
#pragma once

#include <cstdint>
#include <random>

namespace common {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), 53 random bits.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high);
  /// Uniform integer in [0, count), unbiased (rejection); count >= 1.
  std::uint64_t index(std::uint64_t count);

 private:
  std::mt19937_64 engine_;
};

}  // namespace common
