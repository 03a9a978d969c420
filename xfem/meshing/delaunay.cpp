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

Triangulation triangulate(std::span<const common::Vec2> points) {
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
  return triangulation;
}

}  // namespace

std::vector<std::array<int, 3>> delaunay(std::span<const common::Vec2> points, int boundary) {
  const Triangulation triangulation = triangulate(points);
  // The convex hull bridges boundary points that lie inside it by rounding: triangles with a free edge that is not a
  // boundary edge are peeled off until none is left.
  std::vector<Triangulation::Edge> free_edges;
  auto outer = triangulation.incident_faces(triangulation.infinite_vertex());
  const auto first = outer;
  do {
    const int k = outer->index(triangulation.infinite_vertex());
    free_edges.push_back(triangulation.mirror_edge({outer, k}));
  } while (++outer != first);
  std::vector<Triangulation::Face_handle> peeled;
  const auto is_peeled = [&](Triangulation::Face_handle face) {
    return std::find(peeled.begin(), peeled.end(), face) != peeled.end();
  };
  int boundary_edges = 0;
  while (!free_edges.empty()) {
    const auto [face, k] = free_edges.back();
    free_edges.pop_back();
    if (triangulation.is_infinite(face) || is_peeled(face)) continue;
    const int from = face->vertex(Triangulation::ccw(k))->info();
    const int to = face->vertex(Triangulation::cw(k))->info();
    if (from < boundary && to == (from + 1) % boundary) {
      ++boundary_edges;
      continue;
    }
    peeled.push_back(face);
    free_edges.push_back(triangulation.mirror_edge({face, Triangulation::ccw(k)}));
    free_edges.push_back(triangulation.mirror_edge({face, Triangulation::cw(k)}));
  }

  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(triangulation.number_of_faces());
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end(); ++face) {
    if (!peeled.empty() && is_peeled(face)) continue;
    std::array<int, 3> t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  const std::size_t expected = 2 * points.size() - 2 - static_cast<std::size_t>(boundary);
  if (boundary_edges != boundary || triangles.size() != expected) {
    throw common::numerical_failure("mesh: the triangulation of " + std::to_string(points.size()) + " points has " +
                                    std::to_string(triangles.size()) + " triangles and " +
                                    std::to_string(boundary_edges) + " boundary edges, expected " +
                                    std::to_string(expected) + " and " + std::to_string(boundary) +
                                    "; the outline is too thin for its coordinates");
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace xfem
