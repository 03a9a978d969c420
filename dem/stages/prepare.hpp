// From a loose random assembly to a sample at rest under isotropic pressure with the wanted void ratio:
//   compaction     affine, at a constant rate, until particles touch: 3 contacts for 4 particles, or a mean stress of
//                  2 % of the pressure
//   relaxation     boundary at rest, until the unbalanced force has died away
//   confinement    both directions servo-controlled to the pressure, with the preparation's high friction
//   densification  friction lowered slowly until the void ratio is nearly met
//   hold           friction of the test, until pressure and unbalanced force are met; back to densification while the
//                  sample at rest is still too loose
#pragma once

#include <string>
#include <vector>

#include "common/config/scene.hpp"
#include "dem/stages/control.hpp"

namespace dem {

/// Simulated time after which a phase ends whatever it has reached [s].
inline constexpr double kLongestPhase = 20;

class Preparation {
 public:
  Preparation(const common::Scene& scene, Engine& engine, Control& control);

  /// One time step; phases follow one another. Afterwards control.phase is shear when the sample is ready.
  void step();

 private:
  void enter(Phase phase);
  void steer(double elapsed);
  double target_void_ratio_error() const;

  const common::Scene& scene_;
  Engine& engine_;
  Control& control_;
};

/// What the user should know of a sample before it is sheared: void ratio off the wanted one by more than the
/// tolerance, not at rest, not under this scene's pressure. Empty if all is well.
std::vector<std::string> shortcomings_of(const common::Scene& scene, const Engine& engine);

/// The scene's void ratio of a state, in the declared definition.
double void_ratio(const State& state, common::VoidRatioDefinition definition);

}  // namespace dem
