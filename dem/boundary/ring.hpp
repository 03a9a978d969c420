// The particles at the rim of an assembly, found by rolling a ball around their centres from outside.
//
// The polygon that the ball traces is the outer boundary of the alpha shape of the centres (Edelsbrunner, Kirkpatrick
// and Seidel 1983), alpha the ball's radius; its edges are Delaunay edges, so it does not cross itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"

namespace dem {

/// Indices of the ring in counter-clockwise order, each once, the lowest index first; they form a simple polygon.
///
/// `ball_radius` [m]: 1.5 times the spacing of neighbouring centres. Below half of the distance of two touching large
/// particles the ball falls in between them; a larger ball bridges dents.
/// Left out: fugitives (all but the largest group of centres with gaps smaller than the ball) and what hangs at the
/// rest by a single centre, where the loop pinches itself. If no loop around most of the assembly exists, the ball
/// grows by a quarter at a time. Empty if the centres do not span a polygon (fewer than three, or on one line).
/// Costs a sort of the centres and some tens of distances for each of them.
/// Throws bad_input if the radius is not positive, numerical_failure if a centre is not finite.
std::vector<std::int32_t> find_ring(std::span<const common::Vec2> centres, double ball_radius);

}  // namespace dem
