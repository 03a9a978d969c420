// Three-node triangle (T3) meshes of convex polygons.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "xfem/canonical.hpp"

namespace xfem {

/// A conforming triangulation with its topology. A pure function of the outline and the requested number of nodes.
struct Mesh {
  std::vector<Vec2> nodes;                    ///< n x 2 [m]
  std::vector<std::array<int, 3>> triangles;  ///< e x 3 node indices, counter-clockwise
  std::vector<std::array<int, 3>>
      neighbours;                   ///< e x 3; triangle across the edge opposite to local node k, -1: boundary
  std::vector<int> element_offset;  ///< n + 1; elements around node i are node_elements[offset[i]...)
  std::vector<int> node_elements;
  std::vector<double> areas;  ///< e [m^2]
  double size = 0;            ///< h: mean edge length [m]

  /// Local number (0..2) of the edge of triangle `t` that lies between nodes a and b (the edge opposite to that local
  /// node); -1 if there is none.
  int local_edge(int t, int a, int b) const;
  Vec2 centroid(int t) const;
  /// Triangle that contains `point` (the nearest one if it is outside by rounding), lowest index on ties.
  int locate(const Vec2& point) const;
};

/// Completes nodes and counter-clockwise triangles to a mesh (neighbours, node -> elements, areas, size).
/// Throws numerical_failure if a triangle has no positive area.
Mesh connect(std::vector<Vec2> nodes, std::vector<std::array<int, 3>> triangles);

/// Nodes of the boundary in counter-clockwise order, from the boundary node of lowest index.
std::vector<int> boundary_loop(const Mesh& mesh);

/// Meshes a convex counter-clockwise outline with about `nodes` nodes (within 10 % where the outline's corners allow),
/// smallest angle >= 20 degrees where the outline allows. All outline vertices are nodes; areas sum to the outline's.
/// Boundary nodes come first, counter-clockwise from outline vertex 0 (which is node 0); triangles ascend.
/// Throws numerical_failure for an outline that cannot be meshed.
Mesh make_mesh(PolygonView outline, int nodes);
/// The mesh of a canonical outline, whose nodes are canonical coordinates.
Mesh make_mesh(const CanonicalOutline& shape, int nodes);

}  // namespace xfem
