// Outlines of all particles, laid out for the overlap kernel: x and y of one particle side by side, four at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/overlap.hpp"
#include "dem/state.hpp"

namespace dem {

struct alignas(32) Quad {
  double value[4];
};

/// World outlines of N particles (m). A particle's quads hold its x, then its y; the last vertex is repeated to fill.
class WorldOutlines {
 public:
  /// Takes the shapes of `particles`; `place` puts them where they are.
  void reset(const Particles& particles);

  /// World outlines of particles first..last-1 at their present positions and angles.
  void place(const Particles& particles, std::size_t first, std::size_t last);

  common::OutlineView operator[](std::int32_t i) const {
    const Shape& s = shapes_[i];
    const double* x = world_[s.first].value;
    return {x, x + s.padded, s.size, s.padded};
  }
  /// Fetches the outline of particle i into the cache; x and y fill two lines for up to 8 vertices.
  void prefetch(std::int32_t i) const {
    const Quad* quad = &world_[shapes_[i].first];
    __builtin_prefetch(quad);
    __builtin_prefetch(quad + 2);
  }
  /// Bounding radius about the centroid [m].
  double radius(std::int32_t i) const { return shapes_[i].radius; }

 private:
  struct Shape {
    std::int32_t first;  ///< index of the first quad
    std::int32_t size, padded;
    double radius;
  };
  std::vector<Shape> shapes_;
  std::vector<Quad> body_, world_;
};

}  // namespace dem
