// A crack as a polyline through the mesh: its points stand on element edges, one element between two points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "xfem/mesh.hpp"

namespace xfem {

/// What became of a crack's end.
enum class TipState : std::int32_t {
  active = 0,       ///< may grow when the stress ahead of it asks for it
  at_boundary = 1,  ///< on the particle's boundary
  at_crack = 2,     ///< ran into another crack (coalescence)
  arrested = 3,     ///< for good: a chip, or no valid way on
};

/// A point of a crack, exactly on a mesh edge.
struct CrackPoint {
  std::array<int, 2> edge;  ///< mesh nodes, the lower index first
  double fraction;          ///< position along the edge, 0 at edge[0], 1 at edge[1]
  Vec2 position;            ///< body frame [m]
};

struct Crack {
  std::vector<CrackPoint> points;  ///< at least 2, in order from the first tip to the last
  std::array<TipState, 2> tips{TipState::active, TipState::active};
};

/// No point stands nearer to an edge's end than this fraction of the edge, so that a crack never runs through a node.
inline constexpr double kEdgeClearance = 0.02;

/// Point of the edge between nodes a and b, in any order, at `fraction` of the way from a, kept clear of the nodes.
CrackPoint point_on_edge(const Mesh& mesh, int a, int b, double fraction);

/// Triangles on both sides of an edge, the lower index first; -1 for none: {t, -1} is a boundary edge.
std::array<int, 2> edge_elements(const Mesh& mesh, const std::array<int, 2>& edge);
bool on_boundary(const Mesh& mesh, const CrackPoint& point);

/// Triangle that holds both edges of two consecutive crack points; -1 if there is none.
int segment_element(const Mesh& mesh, const CrackPoint& first, const CrackPoint& last);

/// Side of the three local nodes of the segment's element: +1 left of the directed segment, -1 right of it.
/// Purely topological: it depends on the two edges, never on a distance.
std::array<int, 3> segment_sides(const Mesh& mesh, int element, const CrackPoint& first, const CrackPoint& last);

/// Empty if the crack fits the mesh (edges exist, one element between two points, no element cut twice, every node on
/// one side only, boundary points only at the ends); otherwise a sentence that says what is wrong.
std::string crack_defect(const Mesh& mesh, const Crack& crack);

/// The crack nearest to a given polyline in `mesh`, for cracks handed down to a fragment, whose mesh is another: the
/// polyline's crossings with the mesh edges, ends cut back to the last edge. Empty if fewer than 2 crossings remain.
Crack place_polyline(const Mesh& mesh, std::span<const Vec2> polyline, std::array<TipState, 2> tips);

}  // namespace xfem
