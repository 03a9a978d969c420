#include "dem/motion.hpp"

#include <algorithm>

namespace dem {

void InverseInertia::reset(const Particles& particles, double least_mass) {
  mass.resize(particles.size());
  moment.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double raise = std::max(1.0, least_mass / particles.mass[i]);
    mass[i] = 1 / (raise * particles.mass[i]);
    moment[i] = 1 / (raise * particles.inertia[i]);
  }
}

double advance(Particles& p, const BodyForces& forces, const InverseInertia& inverse, const StrainRate& rate, double dt,
               bool ledger, std::size_t first, std::size_t last) {
  double work = 0;
  for (std::size_t i = first; i < last; ++i) {
    if (p.boundary[i]) {
      const Vec2 velocity(-rate.xx * p.position[i].x(), -rate.yy * p.position[i].y());
      if (ledger) {
        // The boundary pushes with the opposite of what the contacts do to it.
        work -= 0.5 * (forces.force[i].dot(p.velocity[i] + velocity) + forces.moment[i] * p.angular_velocity[i]) * dt;
      }
      p.velocity[i] = velocity;
      p.angular_velocity[i] = 0;
    } else {
      p.velocity[i] += forces.force[i] * (dt * inverse.mass[i]);
      p.angular_velocity[i] += forces.moment[i] * (dt * inverse.moment[i]);
    }
    const Vec2 move = p.velocity[i] * dt;
    p.position[i] += move;
    p.displacement[i] += move;
    p.angle[i] += p.angular_velocity[i] * dt;
  }
  return work;
}

double kinetic_energy(const Particles& particles, double least_mass) {
  double sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.boundary[i]) continue;
    const double raise = std::max(1.0, least_mass / particles.mass[i]);
    sum += raise * (0.5 * particles.mass[i] * particles.velocity[i].squaredNorm() +
                    0.5 * particles.inertia[i] * particles.angular_velocity[i] * particles.angular_velocity[i]);
  }
  return sum;
}

}  // namespace dem
