// Pairs that may touch: sweep along x over bounding circles grown by a skin, rebuilt when somebody may have crossed it.
// A sweep needs no grid, so neither a size ratio of 100:1 nor a particle that flies off costs memory.
#pragma once

#include <vector>

#include "dem/contact/forces.hpp"
#include "dem/state.hpp"

namespace dem {

class Neighbours {
 public:
  /// `skin`: how far two outlines may approach each other before the list is rebuilt [m].
  explicit Neighbours(double skin) : skin_(skin) {}

  /// True if a particle may have moved by more than half the skin since the list was built (translation, and rotation
  /// times radius).
  bool outdated(const Particles& particles, const std::vector<double>& radius) const;

  /// Writes every pair whose bounding circles, grown by half the skin, overlap; ascending by (a, b).
  void rebuild(const Particles& particles, const std::vector<double>& radius, std::vector<Pair>& pairs);

 private:
  double skin_;
  std::vector<Vec2> position_;
  std::vector<double> angle_;
  std::vector<std::int32_t> order_;
};

}  // namespace dem
