// A dense assembly under pressure for the benchmarks, made once.
#pragma once

#include "common/config/scene.hpp"
#include "dem/engine.hpp"
#include "dem/stages/generate.hpp"
#include "dem/stages/prepare.hpp"

namespace bench {

inline common::Scene pile_scene() {
  common::Scene scene;
  scene.effects = {true, true, false, true};
  scene.assembly.particles = 600;
  scene.preparation.void_ratio = 0.27;
  return scene;
}

/// A prepared sample at rest at 2 MPa.
inline const dem::State& pile() {
  static const common::Scene scene = pile_scene();
  static const dem::State state = [] {
    dem::State start;
    start.particles = dem::generate_assembly(scene.assembly, scene.material.density, scene.seed);
    start.friction = scene.preparation.initial_friction;
    start.next_id = static_cast<std::int64_t>(start.particles.size());
    dem::Engine engine(scene, start);
    dem::Control control;
    dem::Preparation preparation(scene, engine, control);
    while (control.phase != dem::Phase::shear) preparation.step();
    return engine.state();
  }();
  return state;
}

}  // namespace bench
