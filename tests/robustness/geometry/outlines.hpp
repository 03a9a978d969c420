// Pairs of convex outlines as the overlap kernel takes them, and the exact arithmetic that makes them convex.
#pragma once

#include <array>

#include "common/geometry/overlap.hpp"

namespace differential {

/// A counter-clockwise polygon as two arrays; after `pad` the entries from `size` up to the next multiple of 4 repeat
/// the last vertex, as common::OutlineView wants it.
struct Outline {
  int size = 0;
  alignas(32) std::array<double, common::kMaxParticleVertices> x;
  alignas(32) std::array<double, common::kMaxParticleVertices> y;

  void add(double px, double py) {
    x[size] = px;
    y[size] = py;
    ++size;
  }
  void pad();
  int next(int i) const { return i + 1 < size ? i + 1 : 0; }
  int previous(int i) const { return i > 0 ? i - 1 : size - 1; }
  common::OutlineView view() const { return {x.data(), y.data(), size, common::padded_size(size)}; }
};

/// Coordinates are relative to one of the two particles.
struct OutlinePair {
  Outline a;
  Outline b;
};

/// Longest distance between two vertices.
double diameter(const Outline& outline);

/// +1, 0, -1: `r` is left of, on, or right of the line from p to q; exactly, for any doubles.
int orientation(double px, double py, double qx, double qy, double rx, double ry);

/// Leaves out the corners that do not turn left, decided exactly. Rounded outlines may turn right by a rounding error
/// at a flat corner; the sets that the two oracles measure are the hulls. Returns how many corners went.
int make_convex(Outline& outline);

}  // namespace differential
