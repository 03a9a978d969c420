// Measures of simple polygons with counter-clockwise vertices (n x 2, m), unit thickness.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace common {

using Polygon = std::vector<Vec2>;
using PolygonView = std::span<const Vec2>;

/// Signed area [m^2]; positive for counter-clockwise vertices. Computed relative to the first vertex.
double area(PolygonView polygon);

/// Area centroid [m].
Vec2 centroid(PolygonView polygon);

/// Polar second moment of area about the centroid [m^4]; times density it is the moment of inertia.
double polar_moment(PolygonView polygon);

/// Longest distance between two vertices [m].
double diameter(PolygonView polygon);

/// Largest distance of a vertex from `center` [m].
double radius_about(PolygonView polygon, const Vec2& center);

/// Empty if the polygon is a usable particle outline (at least 3 vertices, finite, strictly positive area, convex,
/// counter-clockwise, no repeated vertex); otherwise a sentence that says what is wrong and at which vertex (0-based).
std::string outline_defect(PolygonView polygon);

/// True if `point` is inside or on the boundary of the convex polygon.
bool contains(PolygonView polygon, const Vec2& point);

/// Diameter of the circle of the same area, De = sqrt(4 A / pi) [m].
double equivalent_diameter(double area);

}  // namespace common
