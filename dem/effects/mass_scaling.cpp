#include "dem/effects/mass_scaling.hpp"

#include <algorithm>

namespace dem {

double least_inertial_mass(const Particles& p, double share) {
  std::vector<std::int64_t> originals = p.root;
  std::sort(originals.begin(), originals.end());
  const auto count = std::unique(originals.begin(), originals.end()) - originals.begin();
  double total = 0;
  for (const double m : p.mass) total += m;
  return count > 0 ? share * total / static_cast<double>(count) : 0;
}

MassScaling mass_scaling(const Particles& p, double least_mass) {
  MassScaling result;
  double total = 0, added = 0;
  for (const double m : p.mass) {
    total += m;
    if (m >= least_mass) continue;
    added += least_mass - m;
    ++result.particles;
  }
  if (total > 0) result.added_mass = added / total;
  return result;
}

}  // namespace dem
