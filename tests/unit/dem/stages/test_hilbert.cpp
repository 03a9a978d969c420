#include <catch2/catch.hpp>
#include <cstdlib>
#include <utility>
#include <vector>

#include "dem/stages/hilbert.hpp"

TEST_CASE("Hilbert's curve of order one visits the quadrants in its order") {
  CHECK(dem::hilbert_index(0, 0, 1) == 0);
  CHECK(dem::hilbert_index(0, 1, 1) == 1);
  CHECK(dem::hilbert_index(1, 1, 1) == 2);
  CHECK(dem::hilbert_index(1, 0, 1) == 3);
}

TEST_CASE("Hilbert's curve visits every cell once and steps from neighbour to neighbour") {
  for (const int levels : {1, 2, 3, 6}) {
    const int side = 1 << levels;
    std::vector<std::pair<int, int>> cells(static_cast<std::size_t>(side) * side, {-1, -1});
    for (int column = 0; column < side; ++column) {
      for (int row = 0; row < side; ++row) {
        const std::uint64_t place =
            dem::hilbert_index(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row), levels);
        REQUIRE(place < cells.size());
        CHECK(cells[place].first == -1);
        cells[place] = {column, row};
      }
    }
    for (std::size_t k = 1; k < cells.size(); ++k) {
      CHECK(std::abs(cells[k].first - cells[k - 1].first) + std::abs(cells[k].second - cells[k - 1].second) == 1);
    }
  }
}

TEST_CASE("Hilbert's curve is the same curve at every resolution") {
  for (std::uint32_t column = 0; column < 64; column += 5) {
    for (std::uint32_t row = 0; row < 64; row += 3) {
      // Two levels more divide each cell in 16, which the finer curve visits one after the other.
      CHECK(dem::hilbert_index(4 * column + 1, 4 * row + 2, 8) / 16 == dem::hilbert_index(column, row, 6));
    }
  }
  CHECK(dem::hilbert_index(2147483647u, 0, 31) == 4611686018427387903u);
}
