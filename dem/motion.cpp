#include "dem/motion.hpp"

namespace dem {

void advance(State& state, const BodyForces& forces, const StrainRate& rate, bool ledger) {
  Particles& p = state.particles;
  const double dt = state.time_step;
  double work = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.boundary[i]) {
      const Vec2 velocity(-rate.xx * p.position[i].x(), -rate.yy * p.position[i].y());
      // The boundary pushes with the opposite of what the contacts do to it.
      work -= 0.5 * (forces.force[i].dot(p.velocity[i] + velocity) + forces.moment[i] * p.angular_velocity[i]) * dt;
      p.velocity[i] = velocity;
      p.angular_velocity[i] = 0;
    } else {
      p.velocity[i] += forces.force[i] * (dt / p.mass[i]);
      p.angular_velocity[i] += forces.moment[i] * (dt / p.inertia[i]);
    }
    const Vec2 move = p.velocity[i] * dt;
    p.position[i] += move;
    p.displacement[i] += move;
    p.angle[i] += p.angular_velocity[i] * dt;
  }
  if (ledger) state.energy.boundary_work += work;
  ++state.step;
  state.time += dt;
}

void transform_outlines(const Particles& particles, std::vector<Vec2>& world) {
  world.resize(particles.vertices.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const common::Rotation rotation(particles.angle[i]);
    const Vec2& position = particles.position[i];
    for (auto v = particles.vertex_offset[i]; v < particles.vertex_offset[i + 1]; ++v) {
      world[v] = position + rotation * particles.vertices[v];
    }
  }
}

double kinetic_energy(const Particles& particles) {
  double sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.boundary[i]) continue;
    sum += 0.5 * particles.mass[i] * particles.velocity[i].squaredNorm() +
           0.5 * particles.inertia[i] * particles.angular_velocity[i] * particles.angular_velocity[i];
  }
  return sum;
}

}  // namespace dem
