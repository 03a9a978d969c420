// What a run says while it goes on: one JSON object per line, the driver puts them into run.jsonl.
#pragma once

#include <string>

#include "dem/engine.hpp"
#include "dem/stages/control.hpp"

namespace dem {

/// Stage, step, void ratio in the scene's definition, mean stress [Pa], friction, unbalanced force ratio, contacts.
std::string preparation_event(const common::Scene& scene, const Engine& engine, const Control& control);

/// Frame to come, step, axial strain and its end, particles, contacts, particles broken so far.
std::string shear_event(const common::Scene& scene, const Engine& engine, const Control& control);

std::string warning_event(const std::string& text);

}  // namespace dem
