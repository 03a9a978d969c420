// A run of seconds: 30 particles, two frames after the first.
#pragma once

#include "common/config/scene.hpp"

namespace dem_test {

inline common::Scene small_scene() {
  common::Scene scene;
  scene.effects.friction = true;
  scene.effects.local_damping = true;
  scene.effects.energy_ledger = true;
  scene.assembly.particles = 30;
  scene.preparation.void_ratio = 0.9;  // met at once
  scene.preparation.unbalanced_force = 0.02;
  scene.shear.axial_strain = 0.002;
  scene.shear.frame_interval = 0.001;
  return scene;
}

}  // namespace dem_test
