// Meshes that are finer near chosen points.
#pragma once

#include <vector>

#include "common/geometry/polygon.hpp"

namespace xfem {

struct Mesh;

struct MeshGrading {
  std::vector<common::Vec2> points;  ///< where the mesh is finer
  double ratio = 1;                  ///< edge length away from the points over that at them, at most 8; 1: even mesh
};

/// As make_mesh (mesh.hpp), graded; the number of nodes stays the one asked for.
Mesh make_graded_mesh(common::PolygonView outline, int nodes, const MeshGrading& grading);

}  // namespace xfem
