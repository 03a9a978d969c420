// What a scene makes `dem` do: for people, before they spend hours on it.
#pragma once

#include <string>

#include "common/config/scene.hpp"

namespace dem {

/// Resolved configuration, effects, contact kernel and the state arrays that will exist, as text.
std::string explain(const common::Scene& scene);

}  // namespace dem
