// Contact geometry on the pairs of a real packing, those in contact and near misses (no contact, but within the skin of
// the neighbour list), at rest and while they move slowly; items are pairs. The lines to compare with:
//   plain    the textbook clip; scale by it where machines are compared
//   clipped  the fallback of the kernel, asked for every pair
//   unknown  the kernel without its memory of the pair
// Instructions per pair: the difference of two runs under callgrind with --benchmark_filter=LINE and other
// --benchmark_min_time, or that of `plain` subtracted.
#include <benchmark/benchmark.h>

#include <array>
#include <numeric>
#include <string>

#include "common/geometry/clip_overlap.hpp"
#include "dem/neighbours.hpp"
#include "pile.hpp"

namespace {

using common::OutlineView;
using common::Overlap;
using common::PairFeature;
using common::Vec2;

/// Poses of the pile: at rest, then every 20 steps of a shear of 0.05 /s.
struct Poses {
  std::vector<dem::WorldOutlines> outlines;
  std::vector<dem::Pair> pairs;
  std::vector<std::array<std::vector<std::size_t>, 2>> listed;  ///< near misses and contacts of a pose
};

const Poses& poses() {
  constexpr int kPoses = 32;
  constexpr double kSkin = 0.02;
  static const Poses made = [] {
    Poses result;
    dem::Engine engine(bench::pile_scene(), bench::pile());
    for (int k = 0; k < kPoses; ++k) {
      const dem::Particles& particles = engine.state().particles;
      dem::WorldOutlines& outlines = result.outlines.emplace_back();
      outlines.reset(particles);
      outlines.place(particles, 0, particles.size());
      if (k == 0) dem::Neighbours(kSkin).rebuild(particles, outlines, result.pairs);
      auto& listed = result.listed.emplace_back();
      for (std::size_t i = 0; i < result.pairs.size(); ++i) {
        const auto [a, b] = result.pairs[i];
        listed[common::clip_overlap(outlines[a], outlines[b]).area > 0].push_back(i);
      }
      for (int step = 0; step < 20; ++step) engine.step({0.05, -0.05});
    }
    return result;
  }();
  return made;
}

/// Sutherland and Hodgman's clip as it is taught, then area and centroid.
double plain_clip(const OutlineView& a, const OutlineView& b) {
  Vec2 buffers[2][common::kMaxOverlapVertices];
  Vec2* from = buffers[0];
  Vec2* to = buffers[1];
  int n = a.size;
  for (int i = 0; i < n; ++i) from[i] = a[i];
  for (int j = 0; j < b.size && n > 0; ++j) {
    const Vec2 start = b[j];
    const Vec2 edge = b[(j + 1) % b.size] - start;
    int kept = 0;
    for (int i = 0; i < n; ++i) {
      const Vec2& p = from[i];
      const Vec2& q = from[(i + 1) % n];
      const double height_p = common::cross(edge, p - start);
      const double height_q = common::cross(edge, q - start);
      if (height_p >= 0) to[kept++] = p;
      if ((height_p >= 0) != (height_q >= 0)) to[kept++] = p + height_p / (height_p - height_q) * (q - p);
    }
    n = kept;
    std::swap(from, to);
  }
  double area = 0;
  Vec2 moment = Vec2::Zero();
  for (int i = 1; i + 1 < n; ++i) {
    const double weight = common::cross(from[i] - from[0], from[i + 1] - from[0]);
    area += 0.5 * weight;
    moment += weight / 6 * (from[0] + from[i] + from[i + 1]);
  }
  benchmark::DoNotOptimize(moment);
  return area;
}

double plain(const OutlineView& a, const OutlineView& b, PairFeature&) {
  return plain_clip(a, b);
}
double clipped(const OutlineView& a, const OutlineView& b, PairFeature&) {
  return common::clip_overlap(a, b).area;
}
double unknown(const OutlineView& a, const OutlineView& b, PairFeature&) {
  PairFeature nothing;
  return common::overlap(a, b, nothing).area;
}
double remembered(const OutlineView& a, const OutlineView& b, PairFeature& feature) {
  return common::overlap(a, b, feature).area;
}

template <double (*kKernel)(const OutlineView&, const OutlineView&, PairFeature&)>
void overlap(benchmark::State& state, bool touching, bool moving) {
  const Poses& all = poses();
  std::vector<PairFeature> features(all.pairs.size());
  std::vector<std::size_t> order(moving ? all.outlines.size() : 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (moving) order.insert(order.end(), order.rbegin(), order.rend());
  std::int64_t pairs = 0;
  double sum = 0;
  for (auto _ : state) {
    for (const std::size_t k : order) {
      for (const std::size_t i : all.listed[k][touching]) {
        const auto [a, b] = all.pairs[i];
        sum += kKernel(all.outlines[k][a], all.outlines[k][b], features[i]);
      }
      pairs += static_cast<std::int64_t>(all.listed[k][touching].size());
    }
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(pairs);
  state.counters["time/pair"] =
      benchmark::Counter(static_cast<double>(pairs), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

template <double (*kKernel)(const OutlineView&, const OutlineView&, PairFeature&)>
bool register_lines(const std::string& name) {
  benchmark::RegisterBenchmark((name + "/in_contact").c_str(), overlap<kKernel>, true, false);
  benchmark::RegisterBenchmark((name + "/near_miss").c_str(), overlap<kKernel>, false, false);
  benchmark::RegisterBenchmark((name + "/moving_contact").c_str(), overlap<kKernel>, true, true);
  benchmark::RegisterBenchmark((name + "/moving_near_miss").c_str(), overlap<kKernel>, false, true);
  return true;
}
[[maybe_unused]] const bool registered =
    register_lines<plain>("overlap/plain") && register_lines<clipped>("overlap/clipped") &&
    register_lines<unknown>("overlap/unknown") && register_lines<remembered>("overlap/remembered");

}  // namespace
