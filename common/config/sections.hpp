// The sections that scenes and laboratory tests share.
#pragma once

#include "common/config/scene.hpp"

namespace common {

/// material.{sigma_ci, m_i, young_modulus, poisson_ratio, plane_stress}; `density` as well where `with_density`.
void bind_material(Specification& keys, MaterialOptions& material, bool with_density);

/// breakage.{initiation_radius, minimum_fragment, minimum_area, max_cracks, literal}: how one particle breaks.
void bind_particle_breakage(Specification& keys, BreakageOptions& breakage);

/// Mesh nodes of a particle, at `path`.
void bind_mesh_nodes(Specification& keys, const std::string& path, int& nodes);

}  // namespace common
