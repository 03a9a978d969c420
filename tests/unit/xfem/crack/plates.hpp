// Meshes and cracks of known geometry for the tests of cracks.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/math/random.hpp"
#include "xfem/crack/path.hpp"
#include "xfem/elasticity/intact_model.hpp"

namespace plates {

using xfem::Crack;
using xfem::CrackPoint;
using xfem::Mesh;
using xfem::Vec2;

/// Rectangle [0, width] x [0, height] of nx x ny cells of two triangles each; `jitter` moves the inner nodes by up to
/// this fraction of a cell.
inline Mesh plate(double width, double height, int nx, int ny, double jitter = 0) {
  common::Random random(7);
  std::vector<Vec2> nodes;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      double x = i;
      double y = j;
      const double dx = jitter * random.uniform(-1, 1);
      const double dy = jitter * random.uniform(-1, 1);
      if (i > 0 && i < nx && j > 0 && j < ny) {
        x += dx;
        y += dy;
      }
      nodes.push_back({x * width / nx, y * height / ny});
    }
  }
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int a = j * (nx + 1) + i;
      const int b = a + 1;
      const int c = a + nx + 1;
      const int d = c + 1;
      triangles.push_back({a, b, d});
      triangles.push_back({a, d, c});
    }
  }
  return xfem::connect(std::move(nodes), std::move(triangles));
}

/// The crack along the straight line from `from` to `to`, with its ends on the boundary if `mouths`.
inline Crack straight_crack(const Mesh& mesh, const Vec2& from, const Vec2& to, bool mouths = false) {
  const auto tip = mouths ? xfem::TipState::at_boundary : xfem::TipState::active;
  const std::array<Vec2, 2> line{from, to};
  return xfem::place_polyline(mesh, line, {tip, tip});
}

inline Vec2 centroid(const Mesh& mesh, int element) {
  const auto& [a, b, c] = mesh.triangles[element];
  return (mesh.nodes[a] + mesh.nodes[b] + mesh.nodes[c]) / 3;
}

/// Consistent nodal forces of a uniform stress (compression positive) on the plate's boundary.
inline Eigen::VectorXd traction_forces(const Mesh& mesh, const xfem::Stress& stress) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(mesh.nodes.size()));
  const std::vector<int> loop = xfem::boundary_loop(mesh);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const int a = loop[k];
    const int b = loop[(k + 1) % loop.size()];
    const Vec2 edge = mesh.nodes[b] - mesh.nodes[a];
    const Vec2 normal(edge.y(), -edge.x());  // outward, times the length
    const Vec2 force(-(stress.xx * normal.x() + stress.xy * normal.y()),
                     -(stress.xy * normal.x() + stress.yy * normal.y()));
    for (const int node : {a, b}) {
      forces[2 * node] += force.x() / 2;
      forces[2 * node + 1] += force.y() / 2;
    }
  }
  return forces;
}

inline constexpr xfem::ElasticConstants kRock{20e9, 0.2, false};

}  // namespace plates
