#include "dem/effects/local_damping.hpp"

#include <cmath>

namespace dem {
namespace {

// Drag on one component: force [N] or moment [N m], velocity at t - dt/2.
double drag(double force, double velocity, double alpha) {
  return velocity == 0 ? 0 : -std::copysign(alpha * std::abs(force), velocity);
}

// Energy that the drag takes out. The work uses the mean of the velocities before and after the step, as the kinetic
// energy does.
double dissipated(double damped, double drag, double velocity, double inverse_inertia, double dt) {
  return -drag * (velocity + 0.5 * damped * inverse_inertia * dt) * dt;
}

}  // namespace

double apply_local_damping(const Particles& p, const InverseInertia& inverse, BodyForces& forces, double alpha,
                           double dt, bool ledger, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) {
    if (p.boundary[i]) continue;
    Vec2& force = forces.force[i];
    double& moment = forces.moment[i];
    const Vec2 drag_force(drag(force.x(), p.velocity[i].x(), alpha), drag(force.y(), p.velocity[i].y(), alpha));
    const double drag_moment = drag(moment, p.angular_velocity[i], alpha);
    force += drag_force;
    moment += drag_moment;
    if (ledger) {
      sum += dissipated(force.x(), drag_force.x(), p.velocity[i].x(), inverse.mass[i], dt) +
             dissipated(force.y(), drag_force.y(), p.velocity[i].y(), inverse.mass[i], dt) +
             dissipated(moment, drag_moment, p.angular_velocity[i], inverse.moment[i], dt);
    }
  }
  return sum;
}

}  // namespace dem
