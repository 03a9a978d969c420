// The intact half of xfem: the model of a new fragment, and the screening of an assembly.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "common/math/random.hpp"
#include "pile.hpp"
#include "xfem/model_cache.hpp"

namespace {

constexpr int kParticles = 1194;
const xfem::ElasticConstants kRock{1, 0.2};

/// Outlines as fragments have them: halves of particles of the pile, cut at random through near the middle.
std::vector<common::Polygon> fragments(int count) {
  std::vector<common::Polygon> result;
  common::Random random(5);
  const auto& particles = bench::pile().particles;
  while (static_cast<int>(result.size()) < count) {
    const auto whole = particles.outline(random.index(particles.size()));
    const double angle = random.uniform(0, 6.28);
    const common::Vec2 along(std::cos(angle), std::sin(angle));
    const common::Vec2 through(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
    common::Polygon part;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const common::Vec2& a = whole[i];
      const common::Vec2& b = whole[(i + 1) % whole.size()];
      const double from = common::cross(along, a - through), to = common::cross(along, b - through);
      if (from >= 0) part.push_back(a);
      if (from * to < 0) part.push_back(a + (b - a) * (from / (from - to)));
    }
    if (part.size() >= 3 && common::outline_defect(part).empty()) result.push_back(std::move(part));
  }
  return result;
}

// Mesh, stiffness, factor and influence of one fragment, mean over many.
void set_up_fragment(benchmark::State& state) {
  const auto outlines = fragments(64);
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& outline = outlines[k++ % outlines.size()];
    xfem::ModelCache cache(static_cast<int>(state.range(0)), kRock, 0.1);
    cache.at(xfem::canonical(outline).outline).wanted = true;
    benchmark::DoNotOptimize(cache.build(1));
  }
}
BENCHMARK(set_up_fragment)->Arg(75)->Arg(150)->Arg(300);

void mesh_fragment(benchmark::State& state) {
  const auto outlines = fragments(64);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(xfem::make_mesh(outlines[k++ % outlines.size()], static_cast<int>(state.range(0))));
  }
}
BENCHMARK(mesh_fragment)->Arg(75)->Arg(150)->Arg(300);

void factorize_fragment(benchmark::State& state) {
  std::vector<xfem::Mesh> meshes;
  for (const auto& outline : fragments(64))
    meshes.push_back(xfem::make_mesh(outline, static_cast<int>(state.range(0))));
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(xfem::IntactModel(meshes[k++ % meshes.size()], kRock));
}
BENCHMARK(factorize_fragment)->Arg(75)->Arg(150)->Arg(300);

void influence_of_fragment(benchmark::State& state) {
  std::vector<xfem::ParticleModel> models;
  for (const auto& outline : fragments(64)) {
    models.emplace_back(xfem::canonical(outline), static_cast<int>(state.range(0)), kRock, 0.1);
  }
  std::size_t k = 0;
  for (auto _ : state) {
    const xfem::ParticleModel& model = models[k++ % models.size()];
    benchmark::DoNotOptimize(xfem::Influence(model.elastic, model.average, model.outline));
  }
}
BENCHMARK(influence_of_fragment)->Arg(75)->Arg(150)->Arg(300);

// 1194 particles with 4 contacts each; time per particle. `shapes`: how many have a model of their own.
void screen(benchmark::State& state) {
  const int shapes = static_cast<int>(state.range(0)), nodes = static_cast<int>(state.range(1));
  std::vector<std::unique_ptr<xfem::Influence>> influence;
  std::vector<common::Polygon> outlines;
  for (const auto& outline : fragments(shapes)) {
    const xfem::ParticleModel model(xfem::canonical(outline), nodes, kRock, 0.1);
    influence.push_back(std::make_unique<xfem::Influence>(model.elastic, model.average, model.outline));
    outlines.push_back(model.outline);
  }
  common::Random random(6);
  std::vector<std::vector<xfem::Load>> loads(kParticles);
  for (int i = 0; i < kParticles; ++i) {
    const common::Polygon& outline = outlines[i % shapes];
    for (int c = 0; c < 4; ++c) {
      const std::size_t k = random.index(outline.size());
      const common::Vec2 edge = outline[(k + 1) % outline.size()] - outline[k];
      loads[i].push_back({outline[k] + random.uniform() * edge, 1e5 * common::perpendicular(edge).normalized()});
    }
  }
  for (auto _ : state) {
    for (int i = 0; i < kParticles; ++i) benchmark::DoNotOptimize(influence[i % shapes]->bound(loads[i], {150e6, 25}));
  }
  state.counters["per_particle"] =
      benchmark::Counter(kParticles, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(screen)->ArgNames({"shapes", "nodes"})->ArgsProduct({{12, kParticles}, {75, 150, 300}});

}  // namespace
