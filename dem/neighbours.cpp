#include "dem/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dem {

bool Neighbours::outdated(const Particles& particles, const std::vector<double>& radius) const {
  if (position_.size() != particles.size()) return true;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double turn = std::abs(particles.angle[i] - angle_[i]) * radius[i];
    const double room = 0.5 * skin_ - turn;
    if (room < 0 || (particles.position[i] - position_[i]).squaredNorm() > room * room) return true;
  }
  return false;
}

void Neighbours::rebuild(const Particles& particles, const std::vector<double>& radius, std::vector<Pair>& pairs) {
  position_ = particles.position;
  angle_ = particles.angle;
  const auto low = [&](std::int32_t i) { return position_[i].x() - radius[i]; };
  order_.resize(particles.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(),
            [&](std::int32_t i, std::int32_t j) { return low(i) != low(j) ? low(i) < low(j) : i < j; });

  pairs.clear();
  for (std::size_t s = 0; s < order_.size(); ++s) {
    const std::int32_t i = order_[s];
    const double end = position_[i].x() + radius[i] + skin_;
    for (std::size_t t = s + 1; t < order_.size() && low(order_[t]) <= end; ++t) {
      const std::int32_t j = order_[t];
      const double reach = radius[i] + radius[j] + skin_;
      if ((position_[j] - position_[i]).squaredNorm() <= reach * reach)
        pairs.push_back({std::min(i, j), std::max(i, j)});
    }
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& p, const Pair& q) { return p.a != q.a ? p.a < q.a : p.b < q.b; });
}

}  // namespace dem
