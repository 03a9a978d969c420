#include "xfem/explain.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "common/error.hpp"
#include "xfem/criterion/hoek_brown.hpp"

namespace xfem {

namespace {

/// The choices that both kinds of case share, one per line.
std::string model_choices(const common::MaterialOptions& material, const common::BreakageOptions& breakage,
                          const common::Effects& effects, int nodes) {
  const HoekBrown rock{material.sigma_ci, material.m_i};
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("  {:<20}{}\n", name, value);
  };
  line("mesh", fmt::format("about {} nodes per particle, three-node triangles (T3)", nodes));
  line("elasticity", fmt::format("{}, E = {:.4g} Pa, nu = {:.3g}; three dofs held, inertia relief",
                                 material.plane_stress ? "plane stress" : "plane strain", material.young_modulus,
                                 material.poisson_ratio));
  line("solver", "sparse factorization, one per outline while it is intact; cracks appended to it");
  line("criterion", fmt::format("Hoek-Brown, sigma_ci = {:.4g} Pa, m = {:.3g}, tensile strength {:.4g} Pa",
                                rock.sigma_ci, rock.m_i, rock.tensile_strength()));
  line("initiation", breakage.literal || breakage.initiation_radius == 0
                         ? std::string("stress of the element itself")
                         : fmt::format("stress averaged over a radius of {:.3g} De, De = sqrt(4 A / pi)",
                                       breakage.initiation_radius));
  line("growth", breakage.literal ? "the paper's reading: adjacent element, point loads"
                                  : "one element per step and tip, patch rule, kink limit, ligament rule");
  if (effects.toughness)
    line("toughness", fmt::format("K_Ic = {:.4g} Pa sqrt(m), interaction integral, largest hoop stress",
                                  material.fracture_toughness));
  if (effects.face_friction) line("face friction", fmt::format("{:.3g}, on closed faces", breakage.face_friction));
  line("cracks", fmt::format("at most {} per particle, shifted Heaviside enrichment, exact cut integration",
                             breakage.max_cracks));
  line("smallest fragment",
       fmt::format("{:.3g} of the parent, {:.3g} m^2", breakage.minimum_fragment, breakage.minimum_area));
  return text;
}

}  // namespace

bool is_lab_test(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw common::bad_input(fmt::format("{}: cannot be read", file.string()));
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("test", 0) != 0) continue;
    const std::size_t next = line.find_first_not_of(" \t", 4);
    if (next != std::string::npos && line[next] == ':') return true;
  }
  return false;
}

std::string explain(const common::Scene& scene) {
  const common::Effects& effects = scene.effects;
  std::string text = "# resolved configuration\n" + common::to_yaml(scene) + "\n# effects that are on\n";
  for (const auto& [name, on] : {std::pair{"friction", effects.friction},
                                 {"local_damping", effects.local_damping},
                                 {"energy_ledger", effects.energy_ledger},
                                 {"breakage", effects.breakage},
                                 {"toughness", effects.toughness},
                                 {"face_friction", effects.face_friction}})
    if (on) text += fmt::format("  {}\n", name);
  if (!effects.breakage)
    return text + "\nbreakage is off: there is nothing for xfem to do in this scene; it has no model and no arrays\n";
  text += "\n# model of a particle\n" + model_choices(scene.material, scene.breakage, effects, scene.breakage.nodes);
  text += fmt::format("  {:<20}boundary particles, and those below {:.3g} m^2\n", "not breakable",
                      2 * scene.breakage.minimum_area);
  text +=
      "\n# arrays\n"
      "  read     particles/{id,position,angle,boundary,vertex_offset,vertices} contacts/{a,b,point,force}\n"
      "  kept     per particle: mesh, stiffness factor, averaging weights; cracks (in the split)\n"
      "  written  particles/{id,status,mean_stress,min_safety_factor,failure_mode}\n"
      "           cracks/{particle,point_offset,points,edge,edge_fraction,tip_state} broken/{parent,path}\n"
      "           fragments/{id,parent,vertex_offset,vertices} refusals/{particle,reason}\n"
      "           work/{screened,solved,growth_steps}\n";
  text += fmt::format("\n# configuration hash (the keys that xfem uses)\n  {}\n",
                      common::config_hash(scene, common::UsedBy::xfem));
  return text;
}

std::string explain(const common::LabTest& test) {
  return "# resolved configuration\n" + common::to_yaml(test) + "\n# model of the specimen\n" +
         model_choices(test.material, test.breakage, test.effects, test.mesh_nodes) +
         "\n# written\n  summary.json  result.h5  specimen.svg  case.yaml\n";
}

}  // namespace xfem
