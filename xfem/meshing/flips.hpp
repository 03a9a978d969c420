// Delaunay triangulations by flips, made quickly where the points are far from one another and kept while they move.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace xfem {

/// Triangles (counter-clockwise) and, opposite to each of their nodes, the triangle beyond that edge (-1: none).
struct Triangulation {
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::array<int, 3>> neighbours;

  Triangulation(std::vector<std::array<int, 3>> counter_clockwise, std::size_t points);

  /// Of points of which the first `boundary` stand on a convex outline, counter-clockwise, the others inside: a fan
  /// around the first inner point, then one insertion after the other. Nothing if there is no inner point, or one
  /// stands too near an edge for plain arithmetic.
  static std::optional<Triangulation> of(std::span<const common::Vec2> points, int boundary);

  /// Lawson's flips: an inner edge whose two opposite angles sum to more than pi (by more than rounding) is exchanged
  /// for the other diagonal, until none is left. False if that does not come to an end, which rounding might do; then
  /// the triangles are of no use.
  bool flip(std::span<const common::Vec2> points);

 private:
  /// The same, beginning with these edges (triangle and local node opposite to it).
  bool flip(std::span<const common::Vec2> points, std::vector<std::pair<int, int>>& open);
};

}  // namespace xfem
