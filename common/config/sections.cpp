#include "common/config/sections.hpp"

namespace common {

void bind_material(Specification& keys, MaterialOptions& material, const std::filesystem::path& case_file) {
  keys.section_file("material.rock", case_file.parent_path(),
                    "a file with keys of material (as in configs/rocks), relative to this one's folder; keys given "
                    "beside it go before; here it has been read");
  keys.text("material.name", material.name, "a name", UsedBy::neither, "of the rock, for people");
  keys.text("material.source", material.source, "a text", UsedBy::neither, "where the rock's numbers are from");
  keys.number("material.density", material.density, kPositive, "kg/m^3", UsedBy::dem, "density of the solid (Table 1)");
  keys.number("material.sigma_ci", material.sigma_ci, kPositive, "Pa", UsedBy::xfem,
              "uniaxial compressive strength of the intact rock, Eq. 4 (Table 1)");
  keys.number("material.m_i", material.m_i, kPositive, "-", UsedBy::xfem,
              "Hoek-Brown constant of the intact rock, Eq. 4; tensile strength = sigma_ci / m_i (Table 1)");
  keys.number("material.young_modulus", material.young_modulus, kPositive, "Pa", UsedBy::xfem,
              "elastic modulus of the rock; stresses and crack paths do not depend on it (Table 1)");
  keys.number("material.poisson_ratio", material.poisson_ratio, {0, 0.5, false, true}, "-", UsedBy::xfem,
              "Poisson's ratio of the rock (Table 1)");
  keys.flag("material.plane_stress", material.plane_stress, UsedBy::xfem,
            "plane stress in place of plane strain (the paper: plane strain)");
  keys.number("material.fracture_toughness", material.fracture_toughness, kPositive, "Pa sqrt(m)", UsedBy::xfem,
              "stress intensity K_Ic at which a crack grows, with effect toughness");
}

void bind_particle_breakage(Specification& keys, BreakageOptions& breakage) {
  keys.number("breakage.initiation_radius", breakage.initiation_radius, {0, 1}, "De", UsedBy::xfem,
              "radius over which stress is averaged where a crack may start, in De = sqrt(4 A / pi); 0: none");
  keys.number("breakage.minimum_fragment", breakage.minimum_fragment, {0, 0.5}, "-", UsedBy::xfem,
              "smallest fragment as a fraction of its parent's area; a smaller chip is not split off");
  keys.number("breakage.minimum_area", breakage.minimum_area, kNonNegative, "m^2", UsedBy::xfem,
              "no fragment smaller than this is made");
  keys.integer("breakage.max_cracks", breakage.max_cracks, 1, 100, "-", UsedBy::xfem,
               "most cracks that one particle may carry");
  keys.number("breakage.face_friction", breakage.face_friction, kNonNegative, "-", UsedBy::xfem,
              "Coulomb coefficient of closed crack faces, with effect face_friction");
  keys.flag("breakage.literal", breakage.literal, UsedBy::xfem,
            "the paper's own reading: point loads, radius 0, growth into the adjacent element only");
}

void bind_mesh_nodes(Specification& keys, const std::string& path, int& nodes) {
  keys.integer(path, nodes, 12, 1'000'000, "-", UsedBy::xfem,
               "finite element nodes of a particle (the paper: 75 on average, Table 1)");
}

}  // namespace common
