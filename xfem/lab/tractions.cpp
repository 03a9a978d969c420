#include "xfem/lab/tractions.hpp"

#include <cmath>

namespace xfem {

std::vector<int> face_nodes(const Mesh& mesh, const Face& face) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i][face.axis] == face.level) nodes.push_back(static_cast<int>(i));
  return nodes;
}

void add_pressure(const Mesh& mesh, const Face& face, double pressure, std::vector<Load>& loads) {
  const auto on_face = [&](int node) { return mesh.nodes[node][face.axis] == face.level; };
  const int along = 1 - face.axis;
  std::vector<double> length(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][(k + 1) % 3], b = mesh.triangles[t][(k + 2) % 3];
      if (mesh.neighbours[t][k] >= 0 || !on_face(a) || !on_face(b)) continue;
      const double half = 0.5 * std::abs(mesh.nodes[a][along] - mesh.nodes[b][along]);
      length[a] += half;
      length[b] += half;
    }
  const double inwards = face.level > 0 ? -1 : 1;
  for (std::size_t i = 0; i < length.size(); ++i) {
    if (length[i] == 0) continue;
    Load load{mesh.nodes[i], {0, 0}};
    load.force[face.axis] = inwards * pressure * length[i];
    loads.push_back(load);
  }
}

}  // namespace xfem
