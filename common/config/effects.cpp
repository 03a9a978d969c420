#include "common/config/effects.hpp"

#include <string>
#include <vector>

#include "common/config/document.hpp"
#include "common/config/suggestion.hpp"
#include "common/config/values.hpp"
#include "common/error.hpp"

namespace common {
namespace {

struct NamedEffect {
  const char* name;
  bool Effects::*member;
  UsedBy used_by;
  std::vector<std::string> keys;  ///< keys and sections that mean nothing without it
  bool of_specimen = false;       ///< acts on one particle alone
};
const std::vector<NamedEffect> kEffects{
    {"friction",
     &Effects::friction,
     UsedBy::dem,
     {"contact.friction", "contact.tangential_stiffness", "preparation.initial_friction"}},
    {"local_damping", &Effects::local_damping, UsedBy::dem, {"damping.local"}},
    {"contact_damping", &Effects::contact_damping, UsedBy::dem, {"damping.contact"}},
    {"rolling_resistance", &Effects::rolling_resistance, UsedBy::dem, {"contact.rolling_friction"}},
    {"gravity", &Effects::gravity, UsedBy::dem, {"gravity"}},
    {"mass_scaling", &Effects::mass_scaling, UsedBy::dem, {"mass_scaling"}},
    {"energy_ledger", &Effects::energy_ledger, UsedBy::dem, {}},
    {"breakage", &Effects::breakage, UsedBy::both, {"breakage"}},
    {"toughness", &Effects::toughness, UsedBy::xfem, {"material.fracture_toughness"}, true},
    {"face_friction", &Effects::face_friction, UsedBy::xfem, {"breakage.face_friction"}, true},
};

std::vector<std::string> effect_names(EffectsOf owner) {
  std::vector<std::string> names;
  for (const NamedEffect& effect : kEffects) {
    if (owner == EffectsOf::scene || effect.of_specimen) names.emplace_back(effect.name);
  }
  return names;
}

Effects read_effects(const Value& list, const std::string& expected, EffectsOf owner) {
  const std::vector<std::string> names = effect_names(owner);
  if (!list.is_list()) refuse(list, "effects", expected);
  Effects effects;
  for (const Value& item : list.items) {
    bool known = false;
    for (const NamedEffect& effect : kEffects) {
      if (!item.is_scalar() || item.text != effect.name) continue;
      if (owner == EffectsOf::specimen && !effect.of_specimen) continue;
      if (effects.*effect.member) {
        throw bad_input(item.where + ": effects: found " + in_quotes(item.text) + " twice, expected each effect once");
      }
      effects.*effect.member = known = true;
    }
    if (known) continue;
    throw bad_input(item.where + ": effects: found " + describe(item) + ", expected " + expected +
                    (item.is_scalar() && !nearest_name(item.text, names).empty() ? suggestion(item.text, names, "")
                                                                                 : std::string()));
  }
  return effects;
}

// The effects that an executable looks at; all of them for printing.
std::string print_effects(const Effects& effects, UsedBy executable) {
  std::vector<std::string> names;
  for (const NamedEffect& effect : kEffects) {
    const bool counts = executable == UsedBy::neither || effect.used_by == executable || effect.used_by == UsedBy::both;
    if (counts && effects.*effect.member) names.emplace_back(effect.name);
  }
  std::string text = "[";
  text += join(names);
  return text + ']';
}

}  // namespace

void bind_effects(Specification& keys, Effects& effects, EffectsOf owner) {
  for (const NamedEffect& effect : kEffects) {
    if (owner == EffectsOf::specimen && !effect.of_specimen) continue;
    for (const std::string& key : effect.keys) keys.only_with(effects.*effect.member, key);
  }
  const std::string expected = "a list of " + join(effect_names(owner));
  keys.custom(
      {"effects", "-", "what exists in the run; what is not named costs nothing", expected, UsedBy::both},
      [=, &effects](const Value& value) { effects = read_effects(value, expected, owner); },
      [&effects](UsedBy executable) { return print_effects(effects, executable); });
}

void check_literal(Specification& keys, const Effects& effects, const BreakageOptions& breakage) {
  if (!breakage.literal || !(effects.toughness || effects.face_friction)) return;
  keys.fail({"breakage.literal", "effects"},
            "breakage.literal: found true with toughness or face_friction among effects, expected false: the paper's "
            "reading has neither");
}

}  // namespace common
