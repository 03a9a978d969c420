// A crack as a polyline through the mesh: its points stand on element edges, one element between two points.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "xfem/mesh.hpp"

namespace xfem {

/// What became of a crack's end.
enum class TipState : std::int32_t {
  active = 0,      ///< may grow when the stress ahead of it asks for it
  at_boundary = 1, ///< on the particle's boundary
  at_crack = 2,    ///< ran into another crack (coalescence)
  arrested = 3,    ///< for good: a chip, or no valid way on
};

/// A point of a crack, exactly on a mesh edge.
struct CrackPoint {
  std::array<int, 2> edge;  ///< mesh nodes, the lower index first
  double fraction;          ///< position along the edge, 0 at edge[0], 1 at edge[1]
  Vec2 position;            ///< body frame [m]
};

struct Crack {
  std::vector<CrackPoint> points;      ///< at least 2, in order from the first tip to the last
  std::array<TipState, 2> tips{TipState::active, TipState::active};
};

/// The crack nearest to a given polyline in `mesh`, for cracks handed down to a fragment, whose mesh is another: the
/// polyline's crossings with the mesh edges, ends cut back to the last edge. Empty if fewer than 2 crossings remain.
Crack place_polyline(const Mesh& mesh, std::span<const Vec2> polyline, std::array<TipState, 2> tips);

}  // namespace xfem
