// Whole dem steps of a dense pile at rest under load, for each contact law; items are contact-steps.
#include <benchmark/benchmark.h>

#include "pile.hpp"

namespace {

void steps(benchmark::State& state, common::ContactLaw law) {
  common::Scene scene = bench::pile_scene();
  scene.contact.law = law;
  if (!common::stiffness_is_per_area(law)) scene.contact.normal_stiffness = 1e9;
  dem::Engine engine(scene, bench::pile());
  for (auto _ : state) engine.step({0.0, 0.0});
  state.SetItemsProcessed(engine.contact_steps());
}
BENCHMARK_CAPTURE(steps, mean_depth, common::ContactLaw::mean_depth);
BENCHMARK_CAPTURE(steps, area, common::ContactLaw::area);
BENCHMARK_CAPTURE(steps, potential, common::ContactLaw::potential);
BENCHMARK_CAPTURE(steps, foundation, common::ContactLaw::foundation);

}  // namespace
