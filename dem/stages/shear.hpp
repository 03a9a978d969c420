// The biaxial test: axial strain (y) at a constant rate, lateral stress (x) held by the servo.
#pragma once

#include "common/config/scene.hpp"
#include "dem/stages/control.hpp"

namespace dem {

class Shear {
 public:
  Shear(const common::Scene& scene, Engine& engine, Control& control);

  /// Makes a prepared state the start of the test: clock, strains, displacements and energies at zero.
  static void begin(Engine& engine, Control& control);

  /// One time step.
  void step();

  /// True when the state has reached the axial strain of frame `control.next_frame`.
  bool frame_due() const;
  /// Number of the last frame of the test.
  std::int64_t last_frame() const;

 private:
  double axial_rate() const;

  const common::Scene& scene_;
  Engine& engine_;
  Control& control_;
};

}  // namespace dem
