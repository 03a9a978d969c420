// One particle in xfem: its model (mesh, stiffness, factor), and an analysis that stays intact or cracks.
#include <benchmark/benchmark.h>

#include "pile.hpp"
#include "xfem/breakage.hpp"

namespace {

const xfem::ElasticConstants kRock{20e9, 0.2};

common::Polygon outline() {
  const auto view = bench::pile().particles.outline(0);
  return {view.begin(), view.end()};
}

void make_model(benchmark::State& state) {
  const common::Polygon polygon = outline();
  for (auto _ : state) {
    benchmark::DoNotOptimize(xfem::ParticleModel(polygon, static_cast<int>(state.range(0)), kRock, 0.1));
  }
}
BENCHMARK(make_model)->Arg(75)->Arg(150)->Arg(300);

// Two opposite forces across the particle, `share` times those at which a crack starts.
// `per_step`: the time over the steps of growth, each of them enrichment, columns of W, Schur complement, contact of
// the faces, stress and tip rule; the intact solution and the start are in it too.
void analyse(benchmark::State& state, double share) {
  const common::Polygon polygon = outline();
  const xfem::ParticleModel model(polygon, static_cast<int>(state.range(0)), kRock, 0.1);
  const common::Vec2 top = polygon[0];
  const xfem::Load loads[] = {{top, -1e6 * top.normalized()}, {-top, 1e6 * top.normalized()}};
  xfem::BreakageParameters parameters;
  parameters.load_factor = share * xfem::analyse(model, loads, {}, parameters).min_safety_factor;
  const int steps = xfem::analyse(model, loads, {}, parameters).growth_steps;
  for (auto _ : state) benchmark::DoNotOptimize(xfem::analyse(model, loads, {}, parameters));
  if (steps == 0) return;
  state.counters["steps"] = steps;
  state.counters["per_step"] =
      benchmark::Counter(steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(analyse, intact, 0.9)->Arg(75)->Arg(150)->Arg(300);
BENCHMARK_CAPTURE(analyse, cracking, 1.1)->Arg(75)->Arg(150)->Arg(300)->Arg(1200);

}  // namespace
