// The sections that scenes and laboratory tests share.
#pragma once

#include "common/config/scene.hpp"

namespace common {

/// material.{rock, name, source, density, sigma_ci, m_i, young_modulus, poisson_ratio, plane_stress,
/// fracture_toughness}; a rock's file is sought from the folder of `case_file`.
void bind_material(Specification& keys, MaterialOptions& material, const std::filesystem::path& case_file);

/// breakage.{initiation_radius, minimum_fragment, minimum_area, max_cracks, face_friction, literal}: how one particle
/// breaks.
void bind_particle_breakage(Specification& keys, BreakageOptions& breakage);

/// Mesh nodes of a particle, at `path`.
void bind_mesh_nodes(Specification& keys, const std::string& path, int& nodes);

}  // namespace common
