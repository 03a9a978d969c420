// The one loop: forces at t -> body effects -> motion -> forces at t + dt.
#pragma once

#include <memory>

#include "common/config/scene.hpp"
#include "dem/contact/forces.hpp"
#include "dem/motion.hpp"
#include "dem/neighbours.hpp"
#include "dem/outlines.hpp"
#include "dem/state.hpp"
#include "dem/team.hpp"

namespace dem {

/// Ratios that tell whether an assembly is at rest and its integration sound.
struct Health {
  double unbalanced_force = 0;  ///< mean |sum F| of the free particles / mean normal force
  double sliding_fraction = 0;  ///< contacts at the Coulomb limit / contacts
};

/// Advances a state. Everything here but the state is either a constant of the scene or recomputable from the state:
/// after `restart` the next steps are the same, bit for bit, whatever came before and for any number of threads.
class Engine {
 public:
  Engine(const common::Scene& scene, State state, int threads = 1);

  /// The state at this instant.
  const State& state() const;
  /// The same, its `contacts` being those of the last call of state() or edit(): for what is looked at every step.
  const State& clock() const { return state_; }
  /// The state for changes from outside (splits, ring, coefficients); `restart` makes them count.
  State& edit();

  /// Forgets every cache, chooses the time step and evaluates the contacts without slip. Called at each frame, also
  /// in an uninterrupted run, so that a resumed one goes on identically. Throws bad_input naming a particle with more
  /// than common::kMaxParticleVertices vertices.
  void restart();

  /// One time step with the boundary moving at `rate`. Afterwards contacts and forces belong to the new positions.
  void step(const StrainRate& rate);

  /// Multiplies the positions of the free particles by `factor`, component by component (affine compression, besides
  /// their own motion); the next step evaluates the contacts.
  void scale_positions(const Vec2& factor);

  Health health() const;
  const ContactConstants& constants() const { return constants_; }
  const std::string& kernel_name() const { return kernel_.name; }
  /// Kinetic energy of the free particles [J], of the masses that they move with.
  double kinetic_energy() const { return dem::kinetic_energy(state_.particles, least_mass_); }
  /// Smallest mass that a particle moves with [kg]; 0 without mass scaling.
  double least_mass() const { return least_mass_; }
  /// Resultant forces of contacts and gravity at the present positions, before damping.
  const BodyForces& forces() const { return forces_; }
  /// Contacts in force.
  std::int64_t contacts() const { return now_.contacts; }
  std::int64_t contact_steps() const { return contact_steps_; }

 private:
  // What the motion of one block of particles sums up.
  struct MotionSums {
    double boundary_work = 0, damping = 0, gravity_work = 0;
    bool outdated = false;

    MotionSums& operator+=(const MotionSums& o) {
      boundary_work += o.boundary_work;
      damping += o.damping;
      gravity_work += o.gravity_work;
      outdated |= o.outdated;
      return *this;
    }
  };

  void check_outlines() const;
  double stable_time_step() const;
  void rebuild();
  ContactSums evaluate(double dt);

  common::Effects effects_;
  double damping_;
  double safety_;
  Vec2 gravity_;
  double mass_share_;
  double least_mass_ = 0;
  std::unique_ptr<Team> team_;  // where it is stays, while an engine may move
  ContactConstants constants_;
  ContactKernel kernel_;
  Neighbours neighbours_;
  mutable State state_;          // its contacts are filled from the slots when somebody asks
  mutable bool stored_ = false;  // the contacts of state_ are those of the slots
  WorldOutlines outlines_;
  InverseInertia inverse_;
  std::vector<Pair> pairs_;
  ContactSlots slots_;
  SlotsOfParticles slots_of_;
  BodyForces forces_;
  ContactSums now_;
  std::vector<ContactSums> contact_sums_;
  std::vector<MotionSums> motion_sums_;
  std::int64_t contact_steps_ = 0;
};

}  // namespace dem
