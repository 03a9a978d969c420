// `dem contacts`: the contact geometry and forces of a given configuration, without a step.
#pragma once

#include <filesystem>

#include "common/config/scene.hpp"

namespace dem {

/// Reads the `particles` group of a file, evaluates the scene's contact law at those positions (no slip; shear
/// histories as stored, if there are any), and writes frame/1. Missing masses, inertias and areas come from the
/// outlines. Throws common::Error.
void write_contacts_of(const std::filesystem::path& particles, const common::Scene& scene,
                       const std::filesystem::path& out);

}  // namespace dem
