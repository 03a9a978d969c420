// The key `effects`: what exists in a run.
#pragma once

#include "common/config/scene.hpp"

namespace common {

enum class EffectsOf {
  scene,     ///< all of them
  specimen,  ///< those that act on one particle alone
};

/// Effects as a list of names, each once.
void bind_effects(Specification& keys, Effects& effects, EffectsOf owner);

/// Fails `breakage.literal` beside an effect that the paper does not have.
void check_literal(Specification& keys, const Effects& effects, const BreakageOptions& breakage);

}  // namespace common
