#include "dem/progress.hpp"

#include <nlohmann/json.hpp>

#include "dem/measures.hpp"
#include "dem/stages/prepare.hpp"

namespace dem {

std::string preparation_event(const common::Scene& scene, const Engine& engine, const Control& control) {
  const State& state = engine.state();
  const auto stress = mean_stress(state, ring_area(state));
  const nlohmann::ordered_json event{{"event", "progress"},
                                     {"stage", name_of(control.phase)},
                                     {"step", state.step},
                                     {"time", state.time},
                                     {"void_ratio", void_ratio(state, scene.preparation.definition)},
                                     {"stress_xx", stress[0]},
                                     {"stress_yy", stress[1]},
                                     {"friction", state.friction},
                                     {"unbalanced_force", engine.health().unbalanced_force},
                                     {"contacts", state.contacts.size()}};
  return event.dump();
}

std::string shear_event(const common::Scene& scene, const Engine& engine, const Control& control) {
  const State& state = engine.state();
  const nlohmann::ordered_json event{{"event", "progress"},
                                     {"stage", "shear"},
                                     {"frame", static_cast<std::int64_t>(control.next_frame)},
                                     {"step", state.step},
                                     {"axial_strain", control.axial_strain()},
                                     {"axial_strain_end", scene.shear.axial_strain},
                                     {"particles", state.particles.size()},
                                     {"contacts", state.contacts.size()},
                                     {"broken", control.broken}};
  return event.dump();
}

std::string warning_event(const std::string& text) {
  return nlohmann::ordered_json{{"event", "warning"}, {"text", text}}.dump();
}

}  // namespace dem
