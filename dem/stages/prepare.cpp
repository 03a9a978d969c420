#include "dem/stages/prepare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/measures.hpp"

namespace dem {
namespace {

constexpr double kContactStress = 0.02;    // of the pressure: particles touch
constexpr double kContactsEach = 0.75;     // contacts per particle: they touch, however stiff they are
constexpr double kRelaxed = 0.05;          // unbalanced force at which relaxation ends
constexpr double kPressureReached = 0.01;  // relative error of both stresses
constexpr double kPressureFollowed = 0.03;
constexpr double kPressureHeld = 0.001;
constexpr int kRingInterval = 50;
constexpr double kFrictionHalving = 0.15;  // [s] in which densification halves the friction
constexpr double kFirstTry = 0.0005;       // above the target: a sample gets hardly denser while it comes to rest
constexpr double kRingFixed = 0.012;       // above the target: the ring stays as it is; one particle is 0.005 of 300
constexpr double kLowestFriction = 0.002;
constexpr double kSettled = 0.003;  // unbalanced force at which a frictionless sample gets no denser

/// Larger relative error of the two normal stresses.
double stress_error(const State& state, double pressure) {
  const auto stress = mean_stress(state, ring_area(state));
  return std::max(std::abs(stress[0] / pressure - 1), std::abs(stress[1] / pressure - 1));
}

}  // namespace

double void_ratio(const State& state, common::VoidRatioDefinition definition) {
  const VoidRatios e = void_ratios(state);
  switch (definition) {
    case common::VoidRatioDefinition::e1:
      return e.e1;
    case common::VoidRatioDefinition::e2:
      return e.e2;
    case common::VoidRatioDefinition::e4:
      break;
  }
  return e.e4;
}

std::vector<std::string> shortcomings_of(const common::Scene& scene, const Engine& engine) {
  const common::PreparationOptions& wanted = scene.preparation;
  const State& state = engine.state();
  std::vector<std::string> texts;
  const double e = void_ratio(state, wanted.definition);
  if (!(std::abs(e - wanted.void_ratio) <= wanted.void_ratio_tolerance)) {
    texts.push_back(
        fmt::format("the sample has a void ratio of {:.4f}, wanted is {:.4f} within {:.4f}; it is used as it is "
                    "(dem/README.md, Preparation, has what can be reached at each pressure)",
                    e, wanted.void_ratio, wanted.void_ratio_tolerance));
  }
  const double unbalanced = engine.health().unbalanced_force;
  const double error = stress_error(state, wanted.confining_pressure);
  if (!(unbalanced <= 1.01 * wanted.unbalanced_force) || !(error <= 1.01 * kPressureHeld)) {
    texts.push_back(
        fmt::format("the sample is not at rest under its pressure: unbalanced force {:.2e}, wanted is {:.2e}; relative "
                    "stress error {:.2e}, wanted is {:.2e}; it is used as it is",
                    unbalanced, wanted.unbalanced_force, error, kPressureHeld));
  }
  return texts;
}

Preparation::Preparation(const common::Scene& scene, Engine& engine, Control& control)
    : scene_(scene), engine_(engine), control_(control) {}

void Preparation::enter(Phase phase) {
  control_.phase = phase;
  control_.phase_start = engine_.state().time;
  if (phase == Phase::hold) engine_.edit().friction = scene_.effects.friction ? scene_.contact.friction : 0;
}

double Preparation::target_void_ratio_error() const {
  return void_ratio(engine_.state(), scene_.preparation.definition) - scene_.preparation.void_ratio;
}

void Preparation::step() {
  if (control_.steps_to_ring-- <= 0) {
    if (control_.phase == Phase::compaction) {
      outline_ring(engine_);
    } else if (control_.phase < Phase::densification || target_void_ratio_error() > kRingFixed) {
      renew_ring(engine_);
    }
    require_interior(engine_.clock());
    control_.steps_to_ring = kRingInterval - 1;
  }
  // The particles inside are carried along: a boundary that pushed alone would densify the layer next to it first, and
  // the arch of that layer would shield the middle from a tenth of the pressure.
  const StrainRate rate{control_.servo_x.rate, control_.servo_y.rate};
  const double compaction = control_.phase == Phase::compaction ? scene_.preparation.compaction_rate : 0;
  engine_.scale_positions(Vec2::Ones() - Vec2(rate.xx + compaction, rate.yy + compaction) * engine_.clock().time_step);
  engine_.step(rate);
  if (control_.steps_to_servo-- <= 0) {
    const int interval = servo_interval(sample_gains(scene_, engine_.state(), scene_.preparation.confining_pressure),
                                        engine_.clock().time_step);
    steer(interval * engine_.clock().time_step);
    control_.steps_to_servo = interval - 1;
  }
}

// Measures the sample, moves the servos, and decides whether the phase has done its work.
void Preparation::steer(double elapsed) {
  const State& state = engine_.state();
  const double p = scene_.preparation.confining_pressure;
  const auto stress = mean_stress(state, ring_area(state));
  const bool late = state.time - control_.phase_start > kLongestPhase;

  if (control_.phase == Phase::compaction) {
    const bool touching =
        static_cast<double>(state.contacts.size()) > kContactsEach * static_cast<double>(state.particles.size());
    if (touching || 0.5 * (stress[0] + stress[1]) > kContactStress * p || late) {
      enter(Phase::relaxation);
      control_.steps_to_ring = 0;
    }
    return;
  }
  if (control_.phase == Phase::relaxation) {
    if (engine_.health().unbalanced_force < kRelaxed || state.time - control_.phase_start > 1) {
      engine_.edit().friction = scene_.effects.friction ? scene_.preparation.initial_friction : 0;
      enter(Phase::confinement);
    }
    return;
  }

  const ServoGains gains = sample_gains(scene_, state, p);
  control_.servo_x.update(gains, p, stress[0], elapsed);
  control_.servo_y.update(gains, p, stress[1], elapsed);
  const double error = stress_error(state, p);

  if (control_.phase == Phase::confinement) {
    if ((error < kPressureReached && engine_.health().unbalanced_force < 0.01) || late) {
      control_.hold_below = scene_.preparation.void_ratio + kFirstTry;
      control_.low_friction = state.friction;
      enter(Phase::densification);
    }
  } else if (control_.phase == Phase::densification) {
    const bool frictionless = state.friction < kLowestFriction;
    const bool settled = frictionless && engine_.health().unbalanced_force < kSettled && error < kPressureFollowed;
    if (void_ratio(state, scene_.preparation.definition) <= control_.hold_below || settled || late) {
      enter(Phase::hold);
    } else if (!frictionless && error < kPressureFollowed) {
      // Only while the servo follows: a sample that lost its pressure would lose its friction for nothing.
      engine_.edit().friction *= 1 - 0.6931471805599453 * elapsed / kFrictionHalving;
      control_.low_friction = state.friction;
    }
  } else {
    const bool rest = engine_.health().unbalanced_force < scene_.preparation.unbalanced_force;
    const double excess = target_void_ratio_error();
    if (error < kPressureHeld && rest && excess > 0.5 * scene_.preparation.void_ratio_tolerance &&
        control_.low_friction > kLowestFriction && !late) {
      // Still too loose: go on from where densification stopped, and try to hold a little denser.
      control_.hold_below =
          std::min(control_.hold_below, void_ratio(state, scene_.preparation.definition)) - 0.5 * excess;
      engine_.edit().friction = control_.low_friction;
      enter(Phase::densification);
    } else if ((error < kPressureHeld && rest) || late) {
      enter(Phase::shear);
    }
  }
}

}  // namespace dem
