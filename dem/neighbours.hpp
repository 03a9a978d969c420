// Pairs that may touch: those whose bounding circles, grown by a skin, overlap. The list is rebuilt when somebody may
// have crossed the skin; turning about the centroid leaves the circles where they are.
//
// Circles are sorted into square cells by levels of size, a factor of two each, and each looks for partners on its own
// level and on the coarser ones. Only occupied cells are stored: neither a size ratio of 100:1 nor a particle that
// flies off costs more than its own entry.
#pragma once

#include <cstdint>
#include <vector>

#include "dem/outlines.hpp"
#include "dem/state.hpp"

namespace dem {

/// Two particles that may touch before the next rebuild; indices, a < b; a pair list ascends by (a, b).
struct Pair {
  std::int32_t a, b;
};

class Neighbours {
 public:
  /// `skin`: how far two particles may approach each other before the list is rebuilt [m].
  explicit Neighbours(double skin) : skin_(skin) {}

  /// Writes every pair whose circles, grown by half the skin each, overlap; pairs of two boundary particles, which
  /// carry no force, are left out (DESIGN section 2, Boundary).
  void rebuild(const Particles& particles, const WorldOutlines& outlines, std::vector<Pair>& pairs);

  /// True if one of particles first..last-1 has moved by more than half the skin since the list was built.
  bool outdated(const Particles& particles, std::size_t first, std::size_t last) const {
    const double room = 0.25 * skin_ * skin_;
    bool moved = false;
    for (std::size_t i = first; i < last; ++i) {
      // Not a number counts as moved: the ring search, which follows sooner or later, names the particle.
      moved |= !((particles.position[i] - position_[i]).squaredNorm() <= room);
    }
    return moved;
  }

 private:
  struct Entry {
    int level;
    double row, column;
    std::int32_t index;
  };
  struct Level {
    int number;
    double cell;    ///< [m]
    double radius;  ///< largest [m]
    std::size_t first, last;
  };
  static bool before(const Entry& l, const Entry& r);
  void sort_into_cells(const Particles& particles, const WorldOutlines& outlines);

  double skin_;
  std::vector<Vec2> position_;
  std::vector<Entry> entries_;
  std::vector<Level> levels_;
  std::vector<Pair> found_;
  std::vector<std::size_t> offset_;
};

}  // namespace dem
