// Where a cell of a square lies along Hilbert's curve.
// D. Hilbert, Mathematische Annalen 38 (1891) 459-460; the construction quadrant by quadrant, in integers.
#pragma once

#include <cstdint>

namespace dem {

/// Place along the curve, 0 to 4^levels - 1, of the cell in `column` and `row` of a square of 2^levels by 2^levels
/// cells (levels 1 to 31; column and row below 2^levels). Each cell has a place of its own, and cells at consecutive
/// places share an edge: what is near along the curve is near in the plane.
std::uint64_t hilbert_index(std::uint32_t column, std::uint32_t row, int levels);

}  // namespace dem
