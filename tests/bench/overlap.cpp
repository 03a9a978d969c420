// Contact geometry on the pairs of a real packing: those in contact, and near misses.
#include "common/geometry/overlap.hpp"

#include <benchmark/benchmark.h>

#include "pile.hpp"

namespace {

struct PairOutlines {
  common::Polygon a, b;
};

std::vector<PairOutlines> pairs(bool touching) {
  const dem::State& state = bench::pile();
  const auto outline = [&](std::size_t i) {
    const common::Rotation rotation(state.particles.angle[i]);
    common::Polygon world;
    for (const common::Vec2& v : state.particles.outline(i))
      world.push_back(state.particles.position[i] + rotation * v);
    return world;
  };
  std::vector<PairOutlines> found;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    for (std::size_t j = i + 1; j < state.particles.size(); ++j) {
      if ((state.particles.position[j] - state.particles.position[i]).norm() > 0.6) continue;
      PairOutlines pair{outline(i), outline(j)};
      if ((common::overlap(pair.a, pair.b).area > 0) == touching) found.push_back(std::move(pair));
    }
  }
  return found;
}

void overlap_pairs(benchmark::State& state, bool touching) {
  const std::vector<PairOutlines> all = pairs(touching);
  for (auto _ : state) {
    for (const PairOutlines& p : all) benchmark::DoNotOptimize(common::overlap(p.a, p.b));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}
BENCHMARK_CAPTURE(overlap_pairs, in_contact, true);
BENCHMARK_CAPTURE(overlap_pairs, near_miss, false);

}  // namespace
