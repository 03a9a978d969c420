#include "dem/explain.hpp"

#include <fmt/format.h>

#include "dem/contact/forces.hpp"

namespace dem {
namespace {

// Names of the arrays that a pair of this scene has: those that are not empty.
std::string contact_arrays(const common::Effects& effects) {
  ContactSlots slots;
  slots.renew({{0, 1}}, effects);
  std::string names;
  slots.for_each_array([&](const char* name, const auto& array) {
    if (array.empty()) return;
    if (!names.empty()) names += ", ";
    names += name;
  });
  return names;
}

}  // namespace

std::string explain(const common::Scene& scene) {
  const common::Effects& e = scene.effects;
  const ContactKernel kernel = select_contact_kernel(scene.contact.law, e);
  const ContactConstants constants = contact_constants(scene);
  std::string text = common::to_yaml(scene);
  const auto line = [&](const std::string& s) { text += "# " + s + "\n"; };
  const auto on = [](bool value) { return value ? "on" : "off"; };
  text += "\n";
  line(fmt::format(
      "effects: friction {}, local damping {}, contact damping {}, rolling resistance {}, gravity {}, mass scaling {}, "
      "energy ledger {}, breakage {}",
      on(e.friction), on(e.local_damping), on(e.contact_damping), on(e.rolling_resistance), on(e.gravity),
      on(e.mass_scaling), on(e.energy_ledger), on(e.breakage)));
  line(fmt::format("contact kernel: {}", kernel.name));
  line(fmt::format("  normal stiffness {:.4g} {}, reference length {:.4g} m", constants.normal_stiffness,
                   common::stiffness_is_per_area(scene.contact.law) ? "N/m^2" : "N/m", constants.length));
  if (e.friction) line(fmt::format("  tangential stiffness {:.4g} N/m", constants.tangential_stiffness));
  if (e.contact_damping) line(fmt::format("  damping {:.4g} of critical", constants.damping));
  if (e.rolling_resistance) {
    line(fmt::format("  rolling friction {:.4g}, rolling stiffness {:.4g} N/m times R^2", constants.rolling_friction,
                     constants.rolling_stiffness));
  }
  std::string body = e.gravity ? "gravity" : "";
  if (e.local_damping) body += body.empty() ? "local damping" : ", local damping";
  line(fmt::format("body effects, one call per step: {}", body.empty() ? "none" : body));
  line(
      "state arrays of a particle: position, velocity, displacement, angle, angular velocity, mass, inertia, area, "
      "outline");
  line("state arrays of a contact: " + contact_arrays(e));
  line(fmt::format("a frame every {:.4g} of axial strain, {}", scene.frame_interval(),
                   e.breakage ? "answered by xfem with a split" : "no breakage analysis"));
  return text;
}

}  // namespace dem
