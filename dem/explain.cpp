#include "dem/explain.hpp"

#include <fmt/format.h>

#include "dem/contact/forces.hpp"

namespace dem {

std::string explain(const common::Scene& scene) {
  const common::Effects& e = scene.effects;
  const ContactKernel kernel = select_contact_kernel(scene.contact.law, e);
  const ContactConstants constants = contact_constants(scene);
  std::string text = common::to_yaml(scene);
  const auto line = [&](const std::string& s) { text += "# " + s + "\n"; };
  const auto on = [](bool value) { return value ? "on" : "off"; };
  text += "\n";
  line(fmt::format("effects: friction {}, local damping {}, energy ledger {}, breakage {}", on(e.friction),
                   on(e.local_damping), on(e.energy_ledger), on(e.breakage)));
  line(fmt::format("contact kernel: {}", kernel.name));
  line(fmt::format("  normal stiffness {:.4g} {}, reference length {:.4g} m", constants.normal_stiffness,
                   common::stiffness_is_per_area(scene.contact.law) ? "N/m^2" : "N/m", constants.length));
  if (e.friction) line(fmt::format("  tangential stiffness {:.4g} N/m", constants.tangential_stiffness));
  line(fmt::format("body effects, one call per step: {}", e.local_damping ? "local damping" : "none"));
  line(
      "state arrays of a particle: position, velocity, displacement, angle, angular velocity, mass, inertia, area, "
      "outline");
  line(fmt::format(
      "state arrays of a contact: pair, feature, overlap area and width, point, normal, normal force, load{}{}",
      e.friction ? ", shear displacement" : "", e.energy_ledger ? ", elastic energy" : ""));
  line(fmt::format("a frame every {:.4g} of axial strain, {}", scene.frame_interval(),
                   e.breakage ? "answered by xfem with a split" : "no breakage analysis"));
  return text;
}

}  // namespace dem
