// What steers a run besides the particles: stage, servo, stretches, counters. Part of every checkpoint.
#pragma once

#include <vector>

#include "common/io/frame.hpp"
#include "dem/drive/servo.hpp"
#include "dem/engine.hpp"

namespace dem {

/// The steps of a preparation, in order (DESIGN section 2, Preparation), then the test itself.
enum class Phase { compaction, relaxation, confinement, densification, hold, shear };
const char* name_of(Phase phase);
common::Stage stage_of(Phase phase);

struct Control {
  Phase phase = Phase::compaction;
  double phase_start = 0;   ///< time at which the phase began [s]
  double hold_below = 0;    ///< void ratio at which densification tries to hold
  double low_friction = 0;  ///< friction that densification had reached then
  Servo servo_x, servo_y;
  double stretch_x = 1;  ///< of the boundary since the start of shear
  double stretch_y = 1;
  double steps_to_ring = 0;    ///< steps until the boundary is looked for again
  double steps_to_servo = 0;   ///< steps until the stress is measured again
  double next_frame = 0;       ///< number of the frame to be written next
  double contact_steps = 0;    ///< contacts evaluated since the start of shear
  double momentum_error = 0;   ///< largest of all splits
  double broken = 0;           ///< particles broken so far
  double solid_area = 0;       ///< of all particles when shear began [m^2]
  double energy_at_start = 0;  ///< elastic and kinetic, when shear began [J]

  double axial_strain() const { return 1 - stretch_y; }
  double lateral_strain() const { return 1 - stretch_x; }
};

/// Checkpoint columns of a control and back. `read_control` throws bad_input naming the missing dataset.
std::vector<common::Column> to_columns(const Control& control);
Control read_control(const common::Frame& frame);

/// Finds the boundary ring anew and sets the flags: the ring's particles and those that leave it with a contact to the
/// boundary of more than three mean forces. Boundary particles exert no force on each other and overlap as they are
/// driven together; letting go of a deep overlap would be a blow to the sample. They stay driven, inside the ring,
/// until the overlap is one that a packing has. Energy that enters or leaves with particles that change sides (their
/// kinetic energy, the contacts between boundary particles, which carry no force) is booked as boundary work.
void renew_ring(Engine& engine);

/// Ring of the present centres without setting any flag (loose assemblies).
void outline_ring(Engine& engine);

/// Throws bad_input unless the state has a boundary ring with particles inside: without them no stress and no void
/// ratio exist.
void require_interior(const State& state);

/// Gains of the present sample.
ServoGains sample_gains(const common::Scene& scene, const State& state, double pressure);

}  // namespace dem
