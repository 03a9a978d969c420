#include "dem/effects/gravity.hpp"

namespace dem {

void add_weights(const Particles& p, const Vec2& acceleration, std::size_t first, std::size_t last,
                 BodyForces& forces) {
  for (std::size_t i = first; i < last; ++i) {
    if (!p.boundary[i]) forces.force[i] += p.mass[i] * acceleration;
  }
}

double power_of_weights(const Particles& p, const Vec2& acceleration, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    if (!p.boundary[i]) sum += p.mass[i] * acceleration.dot(p.velocity[i]);
  }
  return sum;
}

}  // namespace dem
