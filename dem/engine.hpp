// The one loop: forces at t -> body effects -> motion -> forces at t + dt.
#pragma once

#include "common/config/scene.hpp"
#include "dem/contact/forces.hpp"
#include "dem/motion.hpp"
#include "dem/neighbours.hpp"
#include "dem/state.hpp"

namespace dem {

/// Ratios that tell whether an assembly is at rest and its integration sound.
struct Health {
  double unbalanced_force = 0;  ///< mean |sum F| of the free particles / mean normal force
  double sliding_fraction = 0;  ///< contacts at the Coulomb limit / contacts
};

/// Advances a state. Everything here but the state is either a constant of the scene or recomputable from the state:
/// after `restart` the next steps are the same, bit for bit, whatever came before.
class Engine {
 public:
  Engine(const common::Scene& scene, State state);

  const State& state() const { return state_; }
  /// The state for changes from outside (splits, ring, coefficients); `restart` makes them count.
  State& edit() { return state_; }

  /// Forgets every cache, chooses the time step and evaluates the contacts without slip. Called at each frame, also
  /// in an uninterrupted run, so that a resumed one goes on identically. Throws bad_input naming a particle with more
  /// than common::kMaxParticleVertices vertices.
  void restart();

  /// One time step with the boundary moving at `rate`. Afterwards contacts and forces belong to the new positions.
  void step(const StrainRate& rate);

  /// Multiplies all positions by `factor` (affine compaction); the next step evaluates the contacts.
  void scale_positions(double factor);

  Health health() const;
  const ContactConstants& constants() const { return constants_; }
  const std::string& kernel_name() const { return kernel_.name; }
  /// Resultant contact forces at the present positions, before damping.
  const BodyForces& forces() const { return work_.forces; }
  std::int64_t contact_steps() const { return contact_steps_; }

 private:
  void evaluate(double dt);
  double stable_time_step() const;

  common::Effects effects_;
  double damping_;
  double safety_;
  ContactConstants constants_;
  ContactKernel kernel_;
  Neighbours neighbours_;
  State state_;
  ContactWork work_;
  std::int64_t contact_steps_ = 0;
};

}  // namespace dem
