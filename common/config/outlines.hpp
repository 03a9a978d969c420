// Particle outlines given by the user: in a scene, or in a file of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry/polygon.hpp"

namespace common {

struct Value;

/// A list of outlines, each a list of [x, y] (any scale, counter-clockwise, convex). `path` names the key in messages.
/// Throws bad_input at the outline's place, with its number (from 0) and the vertex that is wrong.
std::vector<Polygon> read_outlines(const Value& list, const std::string& path);

/// A file of outlines: CSV with rows type,x,y (vertices in order; a header line and lines that start with # are
/// skipped; a new outline starts where `type` changes), or YAML with a list as above. The ending .csv means CSV,
/// any other YAML. Throws bad_input with FILE:LINE.
std::vector<Polygon> read_outline_file(const std::filesystem::path& file);

/// [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], ...]
std::string print_outlines(const std::vector<Polygon>& outlines);

}  // namespace common
