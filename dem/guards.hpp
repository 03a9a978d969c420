// What stops a run that went wrong, before its results look plausible. Every check is of a state or of rows of the
// history, changes neither, and throws a NumericalFailure that names the particles and the numbers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/config/scene.hpp"
#include "common/error.hpp"
#include "common/io/frame.hpp"
#include "common/io/split.hpp"
#include "dem/stages/control.hpp"

namespace dem {

/// Which guard found what, where.
struct Finding {
  std::string guard;                    ///< key of the scene section guards, or finite, contact, refusals
  std::string text;                     ///< what was found and what was expected
  std::vector<std::int64_t> particles;  ///< ids, those of a contact together
  std::vector<std::pair<std::string, double>> numbers;
};

class NumericalFailure : public common::Error {
 public:
  explicit NumericalFailure(Finding finding)
      : Error(common::ExitCode::numerical_failure, finding.text), finding_(std::move(finding)) {}
  const Finding& finding() const { return finding_; }

 private:
  Finding finding_;
};

/// Positions, angles, velocities, forces and moments are numbers. Names the first particle of which one is not.
void require_finite(const Particles& particles, const BodyForces& forces);
/// The same of the positions alone, before they are sorted in space.
void require_finite_positions(const Particles& particles);

/// Every contact is one that two convex outlines can have: forces, area and width are numbers >= 0, the normal is a
/// unit vector, the overlap is no larger than the smaller particle; and it is at most guards.overlap of that one. Names
/// the worst contact.
void require_possible_contacts(const State& state, double largest_overlap);

/// `duration` seconds more take at most guards.steps steps. Names the lightest particle, which sets the time step.
void require_progress(const State& state, double duration, double most_steps);

/// |energy_residual| is below guards.energy_residual of the energy that the test has turned over, with the ledger: of
/// the boundary work and the stored energy, but at least of what was stored when shear began, and of 1e-4 of pressure
/// times area: a sample that nothing touches yet stores nothing. Sound runs stay below
/// 0.5 %. Names the deepest contact and the fastest particle, in energy. `residual` and `elastic` are those of the
/// history's last row [J].
void require_balanced_energy(const common::Scene& scene, const Engine& engine, const Control& control, double residual,
                             double elastic);

/// Judges the rows since the last frame. With local damping and slow loading (inertial number below 0.01) the
/// unbalanced force has fallen below guards.unbalanced_force: its smallest value between two frames is, in sound runs
/// at 0.02 /s, below 0.002 without breakage (100 particles or more, four laws) and 0.012 with it, 0.021 at 0.2 /s;
/// above 0.037 in ones whose time step or servo is unstable, while their stresses stay plausible. If `steps`, those
/// since the last frame, are less than 1000, the limit is 1000 / steps times as large, for a split shakes that long: of
/// 40 splits in 100 particles 0.11 remains after 140 steps, 0.025 after 290. Where a share of more than 0.02 of the
/// particles was split since the last frame (`split_share`) the limit is that much higher: the sample collapses and is
/// built anew (measured: up to 0.04 over 1400 steps with a share of 0.11). Names the particle that is worst off now.
void require_rest(const common::Scene& scene, const std::vector<common::Column>& history, const Engine& engine,
                  std::int64_t steps, double split_share);

/// The same rows, if there are two at least: the lateral stress has come within guards.servo_error of its target once,
/// or it has come nearer.
void require_lateral_stress(const common::Scene& scene, const std::vector<common::Column>& history);

/// No particle's analysis was refused, unless guards.refusals says that the run goes on.
void require_answers(const common::Scene& scene, const common::Split& split);

}  // namespace dem
