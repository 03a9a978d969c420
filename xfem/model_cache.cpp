#include "xfem/model_cache.hpp"

#include <cstring>

#include "xfem/parallel.hpp"

namespace xfem {

ModelCache::ModelCache(int nodes, const ElasticConstants& constants, double averaging_radius_in_de)
    : nodes_(nodes), constants_(constants), averaging_radius_(averaging_radius_in_de) {
  constants_.young_modulus = 1;
}

bool ModelCache::ByBits::operator()(const Polygon& a, const Polygon& b) const {
  if (a.size() != b.size()) return a.size() < b.size();
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec2)) < 0;
}

void ModelCache::start_round() {
  std::erase_if(entries_, [&](const auto& item) { return item.second.used < round_; });
  ++round_;
}

ModelCache::Entry& ModelCache::at(const Polygon& canonical_outline) {
  Entry& entry = entries_[canonical_outline];
  entry.used = round_;
  return entry;
}

int ModelCache::build(int threads) {
  std::vector<std::pair<const Polygon*, Entry*>> missing;
  for (auto& [outline, entry] : entries_) {
    if (!entry.wanted) continue;
    entry.wanted = false;
    missing.emplace_back(&outline, &entry);
  }
  for_each_guarded(
      missing.size(), threads, [&](std::size_t k) -> std::string& { return missing[k].second->failure; },
      [&](std::size_t k) {
        CanonicalOutline shape;
        shape.outline = *missing[k].first;
        ParticleModel particle(shape, nodes_, constants_, averaging_radius_);
        std::optional<Influence> influence;
        if (nodes_ <= kLargestScreenedMesh) influence.emplace(particle.elastic, particle.average, shape.outline);
        missing[k].second->model.reset(new SharedModel{std::move(particle), std::move(influence)});
      });
  return static_cast<int>(missing.size());
}

}  // namespace xfem
