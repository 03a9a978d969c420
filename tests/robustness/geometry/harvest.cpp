#include "tests/robustness/geometry/harvest.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "common/io/split.hpp"
#include "dem/checkpoint.hpp"
#include "dem/fragments.hpp"

namespace differential {
namespace {

using common::Vec2;

constexpr std::size_t kBlock = 256;

void write_outline(const common::Particles& particles, std::size_t i, const Vec2& origin, Outline& outline) {
  const common::Rotation rotation(particles.angle[i]);
  const Vec2 position = particles.position[i] - origin;
  outline.size = 0;
  for (const Vec2& v : particles.outline(i)) {
    const Vec2 p = position + rotation * v;
    outline.add(p.x(), p.y());
  }
  outline.pad();
}

/// Calls `visit(a, b)` for every pair of particles whose circles are within `skin`, a < b.
template <class Visit>
void for_each_candidate(const common::Particles& p, double skin, const Visit& visit) {
  std::vector<double> radius(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) radius[i] = common::radius_about(p.outline(i), Vec2::Zero());
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0);
  const auto low = [&](std::size_t i) { return p.position[i].x() - radius[i]; };
  std::sort(order.begin(), order.end(), [&](auto i, auto j) { return low(i) != low(j) ? low(i) < low(j) : i < j; });
  for (std::size_t s = 0; s < order.size(); ++s) {
    const std::size_t i = order[s];
    for (std::size_t t = s + 1; t < order.size(); ++t) {
      const std::size_t j = order[t];
      if (low(j) > p.position[i].x() + radius[i] + skin) break;
      const double reach = radius[i] + radius[j] + skin;
      if ((p.position[j] - p.position[i]).squaredNorm() <= reach * reach) visit(std::min(i, j), std::max(i, j));
    }
  }
}

/// Steps and hands every block of candidates to `examine(samples)`, which leaves the pairs' features in them and says
/// whether to go on.
template <class Examine>
void replay(dem::Engine& engine, const common::Scene& scene, const HarvestOptions& options, const Examine& examine) {
  const dem::StrainRate rate{-0.5 * scene.shear.strain_rate, scene.shear.strain_rate};
  const common::Particles& particles = engine.clock().particles;
  std::unordered_map<std::uint64_t, common::PairFeature> features;  // never iterated
  const auto feature_of = [&](std::size_t a, std::size_t b) -> common::PairFeature& {
    return features[static_cast<std::uint64_t>(a) << 32 | b];
  };
  std::vector<Sample> block;
  std::vector<std::pair<std::size_t, std::size_t>> indices;
  bool going = true;
  const auto flush = [&] {
    if (!block.empty() && going) going = examine(std::span<Sample>(block));
    for (std::size_t k = 0; k < block.size(); ++k) feature_of(indices[k].first, indices[k].second) = block[k].feature;
    block.clear();
    indices.clear();
  };
  for (int step = 0; step <= options.steps && going; ++step) {
    if (step > 0) engine.step(rate);
    if (step % options.every != 0) continue;
    for_each_candidate(particles, scene.neighbours.skin * scene.assembly.diameter_min,
                       [&](std::size_t a, std::size_t b) {
                         Sample& sample = block.emplace_back();
                         const Vec2 origin = options.world ? Vec2(Vec2::Zero()) : particles.position[a];
                         write_outline(particles, a, origin, sample.pair.a);
                         write_outline(particles, b, origin, sample.pair.b);
                         sample.feature = feature_of(a, b);
                         sample.key = {0, step, particles.id[a], particles.id[b]};
                         indices.emplace_back(a, b);
                         if (block.size() == kBlock) flush();
                       });
    flush();
  }
}

}  // namespace

void harvest(dem::Engine& engine, const common::Scene& scene, std::int64_t source, const HarvestOptions& options,
             Kernel kernel, Tally& tally) {
  std::int64_t count = 0;
  replay(engine, scene, options, [&](std::span<Sample> samples) {
    for (Sample& sample : samples) {
      sample.key[0] = source;
      sample.exact = options.exact_stride > 0 && count % options.exact_stride == 0;
      ++count;
    }
    check(samples, kernel, tally);
    return count < options.pairs;
  });
}

dem::Engine engine_at(const std::filesystem::path& file, const common::Scene& scene) {
  dem::Engine engine(scene, dem::to_state(common::read_frame(file)));
  const std::filesystem::path split = file.parent_path().parent_path() / "splits" / file.filename();
  if (std::filesystem::exists(split)) {
    dem::apply_split(engine.edit(), common::read_split(split), scene.material.density);
    engine.restart();
  }
  return engine;
}

std::optional<Sample> harvested_sample(dem::Engine& engine, const common::Scene& scene, const CaseKey& key,
                                       const HarvestOptions& options, Kernel kernel) {
  std::optional<Sample> found;
  replay(engine, scene, options, [&](std::span<Sample> samples) {
    for (Sample& sample : samples) {
      if (std::equal(key.begin() + 1, key.end(), sample.key.begin() + 1)) found = sample;
      kernel(sample.pair.a.view(), sample.pair.b.view(), sample.feature, nullptr);
    }
    return !found;
  });
  return found;
}

}  // namespace differential
