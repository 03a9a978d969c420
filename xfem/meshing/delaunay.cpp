#include "xfem/meshing/delaunay.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <string>

#include "common/error.hpp"

namespace xfem {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;

std::vector<std::array<int, 3>> triangulate(std::span<const common::Vec2> points) {
  Triangulation triangulation;
  Triangulation::Face_handle hint;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto vertex = triangulation.insert({points[i].x(), points[i].y()}, hint);
    if (triangulation.number_of_vertices() != i + 1) {
      throw common::numerical_failure("mesh: points " + std::to_string(vertex->info()) + " and " + std::to_string(i) +
                                      " coincide");
    }
    vertex->info() = static_cast<int>(i);
    hint = vertex->face();
  }
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(triangulation.number_of_faces());
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end(); ++face) {
    std::array<int, 3> t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  return triangles;
}

/// Edges as (from, to, triangle), sorted, for the search of the triangle on the other side.
struct DirectedEdge {
  int from, to, triangle;
  auto operator<=>(const DirectedEdge&) const = default;
};

std::vector<DirectedEdge> directed_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) edges.push_back({triangles[t][k], triangles[t][(k + 1) % 3], static_cast<int>(t)});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace

std::vector<std::array<int, 3>> delaunay(std::span<const common::Vec2> points, int boundary) {
  std::vector<std::array<int, 3>> triangles = triangulate(points);
  // The convex hull bridges boundary points that lie inside it by rounding. Triangles that have a free edge which is
  // not a boundary edge are peeled off until none is left.
  while (true) {
    const std::vector<DirectedEdge> edges = directed_edges(triangles);
    std::vector<bool> outside(triangles.size(), false);
    int free_edges = 0;
    bool peeled = false;
    for (const DirectedEdge& edge : edges) {
      const auto twin = std::lower_bound(edges.begin(), edges.end(), DirectedEdge{edge.to, edge.from, -1});
      if (twin != edges.end() && twin->from == edge.to && twin->to == edge.from) continue;
      ++free_edges;
      if (edge.from < boundary && edge.to == (edge.from + 1) % boundary) continue;
      outside[edge.triangle] = peeled = true;
    }
    if (!peeled) {
      const std::size_t expected = 2 * points.size() - 2 - static_cast<std::size_t>(boundary);
      if (free_edges == boundary && triangles.size() == expected) break;
      throw common::numerical_failure("mesh: the triangulation of " + std::to_string(points.size()) + " points has " +
                                      std::to_string(triangles.size()) + " triangles and " +
                                      std::to_string(free_edges) + " boundary edges, expected " +
                                      std::to_string(expected) + " and " + std::to_string(boundary) +
                                      "; the outline is too thin for its coordinates");
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (!outside[t]) triangles[kept++] = triangles[t];
    }
    triangles.resize(kept);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace xfem
