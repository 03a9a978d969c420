#include "dem/stages/hilbert.hpp"

#include <utility>

namespace dem {

std::uint64_t hilbert_index(std::uint32_t column, std::uint32_t row, int levels) {
  std::uint64_t index = 0;
  for (int level = levels - 1; level >= 0; --level) {
    const std::uint32_t right = (column >> level) & 1u;
    const std::uint32_t upper = (row >> level) & 1u;
    // The curve visits the quadrants in the order lower left, upper left, upper right, lower right.
    index = 4 * index + (3 * right ^ upper);
    if (upper == 1) continue;
    // The first and the last quadrant hold the curve mirrored about a diagonal. Higher bits are turned too: they count
    // no more.
    if (right == 1) {
      column = ~column;
      row = ~row;
    }
    std::swap(column, row);
  }
  return index;
}

}  // namespace dem
