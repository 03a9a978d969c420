// The load at which a disc splits.
#pragma once

#include "common/config/scene.hpp"

namespace xfem {

/// First failure of the centre of a disc of diameter D by Hoek-Brown [N/m]: for point forces (arc = 0)
/// pi D sigma_t / 2 * 2 m / (m + sqrt(m^2 + 64)) with sigma_t = sigma_ci / m; for forces spread over an arc of length
/// `arc` [m] at either end see brazilian.cpp.
double disc_load(const common::MaterialOptions& material, double diameter, double arc = 0);

}  // namespace xfem
