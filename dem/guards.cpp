#include "dem/guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace dem {
namespace {

constexpr double kSlow = 0.01;          // inertial number up to which an assembly should be near rest
constexpr double kShaken = 1000;        // steps after which nothing of a split is left
constexpr double kFewSplit = 0.02;      // share of the particles that may split without shaking the whole sample
constexpr double kUnstored = 1e-4;      // energy of a sample that nothing has loaded yet, over pressure times area
constexpr double kUnitNormal = 1e-9;    // error of its squared length
constexpr double kAreaRounding = 1e-9;  // of the smaller particle, by which an overlap may exceed it

const std::vector<double>& rows(const std::vector<common::Column>& history, const char* name) {
  const auto found = std::find_if(history.begin(), history.end(), [&](const auto& c) { return c.name == name; });
  if (found == history.end() || found->values.empty()) {
    throw common::numerical_failure(fmt::format("history/{}: no row since the last frame", name));
  }
  return found->values;
}

// 0 for a number, NaN otherwise: sums of it cost no branch.
double trace_of(double x) {
  return x - x;
}
double trace_of(const Vec2& v) {
  return trace_of(v.x()) + trace_of(v.y());
}

// Share of the smaller particle that a contact covers.
double cover(const Contact& c, const Particles& p) {
  return c.overlap_area / std::min(p.area[c.a], p.area[c.b]);
}

std::string where(const Particles& p, std::size_t i) {
  return fmt::format("particle {} at ({:.4g}, {:.4g}) m", p.id[i], p.position[i].x(), p.position[i].y());
}

[[noreturn]] void not_a_number(const Particles& p, std::size_t i, const char* what, double value) {
  throw NumericalFailure({"finite", fmt::format("{} of particle {} is {}", what, p.id[i], value), {p.id[i]}, {}});
}

}  // namespace

void require_finite(const Particles& p, const BodyForces& forces) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double trace = trace_of(p.position[i]) + trace_of(p.velocity[i]) + trace_of(p.angle[i]) +
                         trace_of(p.angular_velocity[i]) + trace_of(forces.force[i]) + trace_of(forces.moment[i]);
    if (trace == 0) continue;
    for (const auto& [what, value] : {std::pair{"the position x", p.position[i].x()},
                                      {"the position y", p.position[i].y()},
                                      {"the velocity x", p.velocity[i].x()},
                                      {"the velocity y", p.velocity[i].y()},
                                      {"the angle", p.angle[i]},
                                      {"the angular velocity", p.angular_velocity[i]},
                                      {"the force x", forces.force[i].x()},
                                      {"the force y", forces.force[i].y()},
                                      {"the moment", forces.moment[i]}}) {
      if (!std::isfinite(value)) not_a_number(p, i, what, value);
    }
  }
}

void require_finite_positions(const Particles& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (trace_of(p.position[i]) == 0) continue;
    const Vec2& at = p.position[i];
    if (std::isfinite(at.x())) not_a_number(p, i, "the position y", at.y());
    not_a_number(p, i, "the position x", at.x());
  }
}

void require_possible_contacts(const State& state, double largest_overlap) {
  const Particles& p = state.particles;
  const Contact* worst = nullptr;
  double most = largest_overlap;
  for (const Contact& c : state.contacts) {
    const double share = cover(c, p);
    const bool possible = c.normal_force >= 0 && trace_of(c.normal_force) + trace_of(c.shear_force) == 0 &&
                          c.overlap_width >= 0 && share <= 1 + kAreaRounding &&
                          std::abs(c.normal.squaredNorm() - 1) <= kUnitNormal;
    if (!possible) {
      throw NumericalFailure(
          {"contact",
           fmt::format(
               "the contact of particles {} and {} is none that two outlines can have: normal force {} N, shear "
               "force {} N, overlap {} m^2 ({} of the smaller particle), width {} m, normal ({}, {})",
               p.id[c.a], p.id[c.b], c.normal_force, c.shear_force, c.overlap_area, share, c.overlap_width,
               c.normal.x(), c.normal.y()),
           {p.id[c.a], p.id[c.b]},
           {{"normal_force", c.normal_force}, {"overlap_area", c.overlap_area}, {"share", share}}});
    }
    if (share <= most) continue;
    most = share;
    worst = &c;
  }
  if (worst == nullptr) return;
  const Contact& c = *worst;
  throw NumericalFailure(
      {"overlap",
       fmt::format("particles {} and {} overlap by {:.3g} of the smaller one's area, expected at most {} "
                   "(guards.overlap); the contacts may be too soft for the pressure, or the time step may be too large",
                   p.id[c.a], p.id[c.b], most, largest_overlap),
       {p.id[c.a], p.id[c.b]},
       {{"share", most}, {"limit", largest_overlap}, {"normal_force", c.normal_force}}});
}

void require_progress(const State& state, double duration, double most_steps) {
  const double steps = duration / state.time_step;
  if (steps <= most_steps) return;
  const Particles& p = state.particles;
  const auto lightest = static_cast<std::size_t>(std::min_element(p.mass.begin(), p.mass.end()) - p.mass.begin());
  throw NumericalFailure(
      {"steps",
       fmt::format(
           "with a time step of {:.3g} s the rest of this stage would take {:.3g} steps, expected at most {:.3g} "
           "(guards.steps); the lightest particle, {} of {:.3g} kg, and the contact stiffness set the time step",
           state.time_step, steps, most_steps, p.id[lightest], p.mass[lightest]),
       {p.id[lightest]},
       {{"time_step", state.time_step}, {"steps", steps}, {"limit", most_steps}, {"mass", p.mass[lightest]}}});
}

void require_balanced_energy(const common::Scene& scene, const Engine& engine, const Control& control, double residual,
                             double elastic) {
  const State& state = engine.state();
  const Particles& p = state.particles;
  const double area = std::accumulate(p.area.begin(), p.area.end(), 0.0);
  const double scale = std::max({std::abs(state.energy.boundary_work) + elastic + std::abs(state.energy.gravity_work),
                                 control.energy_at_start, kUnstored * scene.preparation.confining_pressure * area});
  if (std::abs(residual) <= scene.guards.energy_residual * scale) return;

  std::string blamed;
  std::vector<std::int64_t> particles;
  const auto deepest = std::max_element(state.contacts.begin(), state.contacts.end(),
                                        [&](const Contact& l, const Contact& r) { return cover(l, p) < cover(r, p); });
  if (deepest != state.contacts.end()) {
    blamed = fmt::format("; the deepest contact is that of particles {} and {}, {:.3g} of the smaller one's area",
                         p.id[deepest->a], p.id[deepest->b], cover(*deepest, p));
    particles = {p.id[deepest->a], p.id[deepest->b]};
  }
  const auto energy_of = [&](std::size_t i) {
    return p.mass[i] * p.velocity[i].squaredNorm() + p.inertia[i] * p.angular_velocity[i] * p.angular_velocity[i];
  };
  std::size_t fastest = p.size();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!p.boundary[i] && (fastest == p.size() || energy_of(i) > energy_of(fastest))) fastest = i;
  }
  if (fastest < p.size()) {
    blamed += fmt::format("; most kinetic energy, {:.3g} J, is in {}", 0.5 * energy_of(fastest), where(p, fastest));
    particles.push_back(p.id[fastest]);
  }
  throw NumericalFailure({"energy_residual",
                          fmt::format("the energy residual is {:.3g} J, expected within {} of {:.3g} J "
                                      "(guards.energy_residual); the time step may be too large (time_step.safety is "
                                      "{}){}",
                                      residual, scene.guards.energy_residual, scale, scene.time_step.safety, blamed),
                          particles,
                          {{"energy_residual", residual}, {"scale", scale}, {"limit", scene.guards.energy_residual}}});
}

void require_rest(const common::Scene& scene, const std::vector<common::Column>& history, const Engine& engine,
                  std::int64_t steps, double split_share) {
  if (!scene.effects.local_damping) return;
  // Frames close together do not see the end of what a split shakes; many splits at once let the sample collapse.
  const double shaken = kShaken / std::max(1.0, static_cast<double>(steps));
  const double limit = scene.guards.unbalanced_force * std::max(1.0, shaken) * std::max(1.0, split_share / kFewSplit);
  const std::vector<double>& unbalanced = rows(history, "unbalanced_force");
  const std::vector<double>& inertial = rows(history, "inertial_number");
  const double least = *std::min_element(unbalanced.begin(), unbalanced.end());
  if (!(least > limit) || !(*std::max_element(inertial.begin(), inertial.end()) < kSlow)) return;

  const Particles& p = engine.clock().particles;
  const BodyForces& forces = engine.forces();
  std::size_t worst = p.size();
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.boundary[i]) continue;
    if (worst == p.size() || forces.force[i].squaredNorm() > forces.force[worst].squaredNorm()) worst = i;
  }
  Finding finding{
      "unbalanced_force",
      fmt::format(
          "the unbalanced force is {:.2g} or more since the last frame, expected below {} "
          "(guards.unbalanced_force); the time step may be too large (time_step.safety is {}), the sample stiffer "
          "than the servo takes it for (servo.modulus is {:.3g} Pa) or far from rest under its pressure",
          least, limit, scene.time_step.safety, scene.servo.modulus),
      {},
      {{"unbalanced_force", least}, {"limit", limit}}};
  if (worst < p.size()) {
    finding.text +=
        fmt::format("; the largest unbalanced force, {:.3g} N, is on {}", forces.force[worst].norm(), where(p, worst));
    finding.particles = {p.id[worst]};
  }
  throw NumericalFailure(finding);
}

void require_lateral_stress(const common::Scene& scene, const std::vector<common::Column>& history) {
  const double pressure = scene.preparation.confining_pressure;
  const double limit = scene.guards.servo_error;
  const std::vector<double>& stress = rows(history, "stress_xx");
  if (stress.size() < 2) return;
  double least = std::numeric_limits<double>::infinity();
  for (const double s : stress) least = std::min(least, std::abs(s / pressure - 1));
  const double first = std::abs(stress.front() / pressure - 1), last = std::abs(stress.back() / pressure - 1);
  if (!(least > limit) || last < first) return;
  throw NumericalFailure(
      {"servo_error",
       fmt::format(
           "the lateral stress is {:.4g} Pa, off its {:.4g} Pa by {:.2g} of it or more since the last frame and "
           "no nearer, expected within {} (guards.servo_error); the strain rate of the servo is {:.3g} /s "
           "(servo.max_rate, servo.modulus), that of the test {} /s",
           stress.back(), pressure, least, limit, rows(history, "servo_rate").back(), scene.shear.strain_rate),
       {},
       {{"stress_xx", stress.back()}, {"confining_pressure", pressure}, {"error", least}, {"limit", limit}}});
}

void require_answers(const common::Scene& scene, const common::Split& split) {
  if (scene.guards.refusals == common::Refusals::go_on || split.refusals.particle.empty()) return;
  const std::int64_t particle = split.refusals.particle.front();
  const std::size_t others = split.refusals.particle.size() - 1;
  throw NumericalFailure({"refusals",
                          fmt::format("the breakage analysis of frame {} was refused for particle {}: {}{}; `--set "
                                      "guards.refusals=continue` leaves such particles as they are",
                                      split.frame, particle, split.refusals.reason.front(),
                                      others > 0 ? fmt::format(" (and for {} more)", others) : ""),
                          split.refusals.particle,
                          {}});
}

}  // namespace dem
