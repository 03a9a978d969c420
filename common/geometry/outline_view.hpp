// Outlines as the overlap kernel reads them: separate coordinates, four at a time.
#pragma once

#include "common/geometry/vec2.hpp"

namespace common {

/// Length of the coordinate arrays of an outline of n vertices: the next multiple of 4.
inline constexpr int padded_size(int n) {
  return (n + 3) / 4 * 4;
}

/// Outline of one convex polygon, counter-clockwise [m]. The entries size..padded-1 repeat the last vertex; `padded` is
/// padded_size(size); x and y are 32-byte aligned.
struct OutlineView {
  const double* x;
  const double* y;
  int size;
  int padded;

  Vec2 operator[](int i) const { return {x[i], y[i]}; }
};

/// Writes vertices [first, last) (anything with x() and y()) to the padded arrays x and y.
template <class Iterator>
OutlineView pack_outline(Iterator first, Iterator last, double* x, double* y) {
  int size = 0;
  for (; first != last; ++first, ++size) {
    x[size] = first->x();
    y[size] = first->y();
  }
  const int padded = padded_size(size);
  for (int i = size; i < padded; ++i) {
    x[i] = x[size - 1];
    y[i] = y[size - 1];
  }
  return {x, y, size, padded};
}

}  // namespace common
