// A small assembly under load, and a split of every third of its particles.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/geometry/chord_split.hpp"
#include "dem/engine.hpp"
#include "dem/fragments.hpp"
#include "dem/stages/control.hpp"
#include "dem/stages/generate.hpp"
#include "tests/unit/dem/bodies.hpp"

namespace piles {

using common::Vec2;

inline common::Scene scene_of(common::ContactLaw law) {
  common::Scene scene;
  scene.effects.friction = true;
  scene.effects.local_damping = true;
  scene.effects.energy_ledger = true;
  scene.contact.law = law;
  scene.contact.normal_stiffness = common::stiffness_is_per_area(law) ? 5e9 : 1e9;
  return scene;
}

inline dem::Engine loaded_pile(const common::Scene& scene) {
  common::AssemblyOptions options;
  options.particles = 60;
  dem::State state;
  state.particles = dem::generate_assembly(options, bodies::kDensity, 8);
  state.next_id = 60;
  state.friction = 0.5;
  dem::Engine engine(scene, state);
  dem::outline_ring(engine);
  for (int k = 0; k < 100000 && engine.state().contacts.size() < 40; ++k) {
    engine.scale_positions(common::Vec2::Constant(1 - 1e-4));
    engine.step({});
  }
  dem::renew_ring(engine);
  for (int k = 0; k < 20000 && engine.state().contacts.size() < 100; ++k) engine.step({0.2, 0.2});
  for (int k = 0; k < 4000; ++k) engine.step({});
  return engine;
}

/// Every third free particle broken from the middle of its first edge to the middle of the opposite one.
inline common::Split cut(const dem::State& state) {
  common::Split split;
  const auto& p = state.particles;
  for (std::size_t i = 0; i < p.size(); i += 3) {
    if (p.boundary[i]) continue;
    const auto outline = p.outline(i);
    const std::size_t k = outline.size() / 2;
    const Vec2 first = (outline[0] + outline[1]) / 2;
    const Vec2 last = (outline[k] + outline[(k + 1) % outline.size()]) / 2;
    const auto halves = common::split_by_chord(outline, first, last);
    split.broken.parent.push_back(p.id[i]);
    split.broken.path.push_back({first, last});
    for (const auto& half : {halves.left, halves.right}) {
      split.fragments.id.push_back(state.next_id + static_cast<std::int64_t>(split.fragments.id.size()));
      split.fragments.parent.push_back(p.id[i]);
      split.fragments.vertices.insert(split.fragments.vertices.end(), half.begin(), half.end());
      split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));
    }
  }
  return split;
}

/// What a split does to the pile: sums and energies after / before.
struct SplitEffect {
  double normal = 0, overlap = 0, shear = 0;  ///< sums of normal forces, overlap areas and |shear forces|
  double rest = 0;                            ///< kinetic energy before / elastic energy before
  double elastic = 0;
  double peak = 0, end = 0;  ///< kinetic energy within 3000 steps, and after them / elastic energy before
};

inline SplitEffect split_effect(const common::Scene& scene) {
  dem::Engine engine = loaded_pile(scene);
  const auto sum = [&](auto&& of) {
    double total = 0;
    for (const dem::Contact& c : engine.state().contacts) total += of(c);
    return total;
  };
  const auto normal = [](const dem::Contact& c) { return c.normal_force; };
  const auto overlap = [](const dem::Contact& c) { return c.overlap_area; };
  const auto shear = [](const dem::Contact& c) { return std::abs(c.shear_force); };
  const auto elastic = [&] { return dem::elastic_energy(engine.state(), engine.constants()); };
  const auto kinetic = [&] { return dem::kinetic_energy(engine.state().particles); };

  const SplitEffect before{sum(normal), sum(overlap), sum(shear), kinetic(), elastic(), 0, 0};
  const auto report = dem::apply_split(engine.edit(), cut(engine.state()), bodies::kDensity);
  engine.restart();
  dem::share_inherited_history(engine.edit(), report);
  engine.restart();
  SplitEffect effect{sum(normal) / before.normal,
                     sum(overlap) / before.overlap,
                     sum(shear) / before.shear,
                     before.rest / before.elastic,
                     elastic() / before.elastic,
                     0,
                     0};
  for (int k = 0; k < 3000; ++k) {
    engine.step({});
    effect.peak = std::max(effect.peak, kinetic() / before.elastic);
  }
  effect.end = kinetic() / before.elastic;
  return effect;
}

}  // namespace piles
