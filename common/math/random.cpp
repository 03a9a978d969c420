#include "common/math/random.hpp"

#include <cmath>

namespace common {

double Random::uniform() {
  return static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double Random::uniform(double low, double high) {
  const double value = low + (high - low) * uniform();
  return value < high ? value : std::nextafter(high, low);  // the sum may round up to `high`
}

std::uint64_t Random::index(std::uint64_t count) {
  // Of the 2^64 values the first (2^64 mod count) are refused, so that the rest is a multiple of count.
  const std::uint64_t refused = (0 - count) % count;
  std::uint64_t value = engine_();
  while (value < refused) value = engine_();
  return value % count;
}

}  // namespace common
