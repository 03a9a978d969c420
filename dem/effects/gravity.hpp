// Gravity: the weight m g acts at the centroid of every free particle. What is driven has its weight carried by its
// drive. m is the true mass, also where mass scaling raises the inertia.
#pragma once

#include "dem/contact/forces.hpp"
#include "dem/state.hpp"

namespace dem {

/// Adds the weights [N] to the resultants of the free particles among first..last-1; `acceleration` in m/s^2.
void add_weights(const Particles& particles, const Vec2& acceleration, std::size_t first, std::size_t last,
                 BodyForces& forces);

/// Power of the weights of particles first..last-1 [W] at the instant of the velocities, sum of m g . v over the free
/// ones. Half a step of it before and half a step after the motion is the work that enters the kinetic energy of the
/// leapfrog velocities.
double power_of_weights(const Particles& particles, const Vec2& acceleration, std::size_t first, std::size_t last);

}  // namespace dem
