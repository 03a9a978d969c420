// The load at which a disc splits.
#pragma once

#include "common/config/scene.hpp"

namespace xfem {

/// First failure of the centre of a disc of diameter D by Hoek-Brown, pi D sigma_t / 2 * 2 m / (m + sqrt(m^2 + 64))
/// with sigma_t = sigma_ci / m [N/m]; see brazilian.cpp.
double disc_load(const common::MaterialOptions& material, double diameter);

}  // namespace xfem
