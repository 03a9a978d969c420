// What particles of one shape share: mesh, factor, averages and influence of the canonical outline.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "xfem/breakage.hpp"
#include "xfem/screening/influence.hpp"

namespace xfem {

/// Meshes with more nodes asked for are not screened: a solve costs as little as reading their influence.
constexpr int kLargestScreenedMesh = 600;

struct SharedModel {
  ParticleModel particle;  ///< canonical coordinates, Young's modulus 1: neither stresses nor cracks depend on it
  std::optional<Influence> influence;
};

/// Models by the bits of the canonical outline. A model is a function of those bits and of the constants alone, so it
/// makes no difference which particle had it made, or when.
class ModelCache {
 public:
  ModelCache(int nodes, const ElasticConstants& constants, double averaging_radius_in_de);

  struct Entry {
    std::unique_ptr<const SharedModel> model;  ///< null: not made yet, or it cannot be made
    std::string failure;                       ///< why it cannot be made
    bool wanted = false;                       ///< to be made by the next `build`
    std::int64_t used = 0;                     ///< last round in which a particle had it
  };

  /// Forgets what no particle has asked for since the last call.
  void start_round();
  /// The entry of an outline; stays where it is until it is forgotten. It is made, if it must be, by `build`.
  Entry& at(const Polygon& canonical_outline);
  /// Makes the wanted models; returns how many.
  int build(int threads);

 private:
  struct ByBits {
    bool operator()(const Polygon& a, const Polygon& b) const;
  };
  int nodes_;
  ElasticConstants constants_;
  double averaging_radius_;
  std::int64_t round_ = 0;
  std::map<Polygon, Entry, ByBits> entries_;
};

}  // namespace xfem
