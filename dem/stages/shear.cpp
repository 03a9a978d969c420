#include "dem/stages/shear.hpp"

#include <algorithm>
#include <cmath>

#include "dem/measures.hpp"

namespace dem {
namespace {

constexpr int kRingInterval = 500;
constexpr double kStrainRounding = 1e-12;

}  // namespace

Shear::Shear(const common::Scene& scene, Engine& engine, Control& control)
    : scene_(scene), engine_(engine), control_(control) {}

void Shear::begin(Engine& engine, Control& control) {
  State& state = engine.edit();
  require_interior(state);
  state.step = 0;
  state.time = 0;
  state.energy = {};
  std::fill(state.particles.displacement.begin(), state.particles.displacement.end(), Vec2::Zero());
  control.phase = Phase::shear;
  control.phase_start = 0;
  control.stretch_x = control.stretch_y = 1;
  control.next_frame = control.contact_steps = control.momentum_error = control.broken = 0;
  control.steps_to_ring = kRingInterval;
  control.steps_to_servo = 0;
  control.solid_area = 0;
  for (const double a : state.particles.area) control.solid_area += a;
  engine.restart();
  control.energy_at_start = elastic_energy(state, engine.constants()) + engine.kinetic_energy();
}

// Grows smoothly from zero, so that the lateral stress does not feel a jolt: s^2 (3 - 2 s), mean 1/2.
double Shear::axial_rate() const {
  const double rate = scene_.shear.strain_rate;
  const double ramp = 2 * scene_.shear.ramp_strain / rate;
  const double time = engine_.clock().time;
  if (time >= ramp) return rate;
  const double s = time / ramp;
  return rate * s * s * (3 - 2 * s);
}

void Shear::step() {
  if (control_.steps_to_ring-- <= 0) {
    renew_ring(engine_);
    control_.steps_to_ring = kRingInterval - 1;
  }
  if (control_.steps_to_servo-- <= 0) {
    const State& state = engine_.state();
    const double p = scene_.preparation.confining_pressure;
    const auto stress = mean_stress(state, ring_area(state));
    const ServoGains gains = sample_gains(scene_, state, p);
    const int interval = servo_interval(gains, state.time_step);
    control_.servo_x.update(gains, p, stress[0], interval * state.time_step);
    control_.steps_to_servo = interval - 1;
  }
  const StrainRate rate{control_.servo_x.rate, axial_rate()};
  control_.stretch_x *= 1 - rate.xx * engine_.clock().time_step;
  control_.stretch_y *= 1 - rate.yy * engine_.clock().time_step;
  engine_.step(rate);
  control_.contact_steps += static_cast<double>(engine_.contacts());
}

std::int64_t Shear::last_frame() const {
  return static_cast<std::int64_t>(std::ceil(scene_.shear.axial_strain / scene_.frame_interval() - 1e-9));
}

bool Shear::frame_due() const {
  const double strain = std::min(control_.next_frame * scene_.frame_interval(), scene_.shear.axial_strain);
  return control_.axial_strain() >= strain - kStrainRounding;
}

}  // namespace dem
