// A loose random assembly of convex polygons in a circle.
#pragma once

#include "common/config/scene.hpp"
#include "common/math/random.hpp"
#include "dem/state.hpp"

namespace dem {

/// The scene's shape types: outlines scaled to diameter 1 (longest distance between two vertices), centroid at the
/// origin, counter-clockwise (clockwise input is turned around).
///
/// Generated types are angular, not rounded: corners_min to corners_max corners in turn, on an ellipse whose ratio of
/// axes is spread evenly over [aspect, 1], at evenly spaced parameters each moved by up to `roughness` spacings. The
/// defaults (5 to 8 corners, roughness 0.4, aspect 0.7) give near-equant particles: area over the area of the circle
/// of the particle's diameter is 0.71 on average (0.41 to 0.9), the family whose contact forces fit most of the
/// paper's tables. They are drawn from `random`.
///
/// Throws bad_input for a non-convex or degenerate outline, naming it, and for options out of range.
std::vector<Polygon> make_shape_types(const common::ShapeOptions& options, common::Random& random);

/// `options.particles` polygons, diameters uniform in [diameter_min, diameter_max] or after the grading, random type,
/// orientation and place, without overlap in a circle that is as small as random placement allows (solids fill about
/// half of it); centred at the origin, at rest. Types, diameters and orientations are drawn first, then places from the
/// largest to the smallest, each by at most 10,000 trials; the circle grows by 2 % and placing begins anew when one
/// finds no room. The ids count from 0 along Hilbert's curve through the places, so that neighbours in space are
/// neighbours in memory. A function of the options and the seed alone.
Particles generate_assembly(const common::AssemblyOptions& options, double density, std::uint64_t seed);

}  // namespace dem
