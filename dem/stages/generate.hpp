// A loose random assembly of convex polygons in a circle.
#pragma once

#include "common/config/scene.hpp"
#include "common/math/random.hpp"
#include "dem/state.hpp"

namespace dem {

/// The scene's shape types: outlines scaled to diameter 1 (longest distance between two vertices), centroid at the
/// origin, counter-clockwise. Generated ones come from `random`. Throws bad_input for a non-convex or degenerate
/// outline, naming it.
std::vector<Polygon> make_shape_types(const common::ShapeOptions& options, const std::filesystem::path& scene_file,
                                      common::Random& random);

/// `options.particles` polygons, diameters uniform in [diameter_min, diameter_max], random type, orientation and place,
/// without overlap in a circle that is as small as random placement allows; centred at the origin, at rest.
/// A function of the seed alone.
Particles generate_assembly(const common::AssemblyOptions& options, const std::filesystem::path& scene_file,
                            double density, std::uint64_t seed);

}  // namespace dem
