#include "dem/contact/forces.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "dem/effects/contact_damping.hpp"
#include "dem/effects/rolling_resistance.hpp"

namespace dem {
namespace {

/// Slots by which the particles of a pair are fetched before they are needed.
constexpr std::size_t kAhead = 8;

struct RelativeVelocity {
  double normal, tangential;
};

RelativeVelocity relative_velocity(const Particles& p, const Pair& pair, const Vec2& point, const Vec2& normal) {
  const Vec2 arm_a = point - p.position[pair.a];
  const Vec2 arm_b = point - p.position[pair.b];
  const Vec2 v = p.velocity[pair.b] + p.angular_velocity[pair.b] * common::perpendicular(arm_b) - p.velocity[pair.a] -
                 p.angular_velocity[pair.a] * common::perpendicular(arm_a);
  return {v.dot(normal), v.dot(common::perpendicular(normal))};
}

// Effects that are part of a contact's evaluation; the index of a kernel in the table is their bits in this order.
struct ContactEffects {
  bool friction, contact_damping, rolling_resistance, energy_ledger;
};
constexpr std::size_t kKernels = 16;

constexpr ContactEffects effects_at(std::size_t index) {
  return {(index & 1) != 0, (index & 2) != 0, (index & 4) != 0, (index & 8) != 0};
}

std::size_t index_of(const common::Effects& e) {
  return std::size_t{e.friction} | std::size_t{e.contact_damping} << 1 | std::size_t{e.rolling_resistance} << 2 |
         std::size_t{e.energy_ledger} << 3;
}

// Forces and stored energy of a contact at one instant; all zero without overlap.
struct Instant {
  double normal_force = 0;  // of the normal law alone
  double viscous_force = 0, shear_force = 0, rolling_moment = 0, elastic_normal = 0;
};

// How the two particles moved relative to each other in the step.
struct Motion {
  RelativeVelocity velocity;
  double spin = 0;  // angular velocity of b less that of a
};

// Energies of the step from `before` to `now`; `kr`: rolling stiffness.
template <class Law, ContactEffects kOn>
void book_work(ContactSums& sums, const Instant& before, const Instant& now, const Motion& motion, double dt, double kt,
               double kr) {
  if constexpr (!Law::kGradient) {
    const double work = -0.5 * (before.normal_force + now.normal_force) * motion.velocity.normal * dt;
    sums.contact_law_work += work - (now.elastic_normal - before.elastic_normal);
  }
  if constexpr (kOn.contact_damping) {
    sums.contact_damping -= 0.5 * (before.viscous_force + now.viscous_force) * motion.velocity.normal * dt;
  }
  if constexpr (kOn.friction) {
    const double work = -0.5 * (before.shear_force + now.shear_force) * motion.velocity.tangential * dt;
    const double stored = 0.5 * (now.shear_force * now.shear_force - before.shear_force * before.shear_force) / kt;
    sums.friction += work - stored;
  }
  if constexpr (kOn.rolling_resistance) {
    const double work = -0.5 * (before.rolling_moment + now.rolling_moment) * motion.spin * dt;
    const double stored =
        0.5 * (now.rolling_moment * now.rolling_moment - before.rolling_moment * before.rolling_moment) / kr;
    sums.rolling += work - stored;
  }
}

double inverse_mass_of(const ContactScene& scene, std::int32_t i) {
  return scene.particles.boundary[i] ? 0 : scene.inverse_mass[i];
}

template <class Law, ContactEffects kOn>
ContactSums evaluate(const ContactScene& scene, ContactSlots& slots, std::size_t first, std::size_t last) {
  const Particles& p = scene.particles;
  const double kt = scene.constants.tangential_stiffness;
  ContactSums sums;
  for (std::size_t k = first; k < last; ++k) {
    const Pair pair = slots.pair[k];
    if (k + kAhead < slots.size()) {
      const Pair& coming = slots.pair[k + kAhead];
      scene.outlines.prefetch(coming.a);
      scene.outlines.prefetch(coming.b);
      __builtin_prefetch(&p.position[coming.b]);
      __builtin_prefetch(&p.velocity[coming.b]);
      __builtin_prefetch(&p.angular_velocity[coming.b]);
    }
    common::OverlapOutline outline;
    const Overlap o = common::overlap(scene.outlines[pair.a], scene.outlines[pair.b], slots.feature[k],
                                      Law::kOutline ? &outline : nullptr);
    const bool known = slots.overlap_area[k] > 0;
    if (!known && !(o.area > 0)) continue;

    double rolling_arm = 0, kr = 0;
    if constexpr (kOn.rolling_resistance) {
      rolling_arm = rolling_radius(p.area[pair.a], p.area[pair.b]);
      kr = scene.constants.rolling_stiffness * rolling_arm * rolling_arm;
    }
    const auto motion_at = [&](const Vec2& point, const Vec2& normal) {
      Motion motion{relative_velocity(p, pair, point, normal)};
      if constexpr (kOn.rolling_resistance) motion.spin = p.angular_velocity[pair.b] - p.angular_velocity[pair.a];
      return motion;
    };

    Instant before;
    if constexpr (kOn.energy_ledger) {
      if (known) {
        before.normal_force = slots.normal_force[k];
        before.elastic_normal = slots.elastic_normal[k];
        if constexpr (kOn.contact_damping) {
          before.viscous_force = slots.viscous_force[k];
          before.normal_force -= before.viscous_force;
        }
        if constexpr (kOn.friction) before.shear_force = -kt * slots.shear_displacement[k];
        if constexpr (kOn.rolling_resistance) before.rolling_moment = slots.rolling_moment[k];
      }
    }
    slots.overlap_area[k] = o.area;
    if (!(o.area > 0)) {
      if constexpr (kOn.energy_ledger) {
        book_work<Law, kOn>(sums, before, {}, motion_at(slots.point[k], slots.normal[k]), scene.dt, kt, kr);
      }
      slots.load[k] = {};
      continue;
    }

    ++sums.contacts;
    const NormalAction action = Law::action(o, outline, scene.constants);
    const Vec2& point = action.point;
    const Vec2& normal = action.normal;
    Instant now;
    now.normal_force = action.force;
    slots.overlap_width[k] = o.width;
    slots.point[k] = point;
    slots.normal[k] = normal;
    if constexpr (kOn.energy_ledger) slots.elastic_normal[k] = now.elastic_normal = action.energy;

    Motion motion{};
    if constexpr (kOn.friction || kOn.contact_damping || kOn.rolling_resistance ||
                  (kOn.energy_ledger && !Law::kGradient)) {
      motion = motion_at(point, normal);
    }
    double total = now.normal_force;
    if constexpr (kOn.contact_damping) {
      now.viscous_force =
          viscous_force(now.normal_force, Law::stiffness_bound(o.width, scene.constants), scene.constants.damping,
                        inverse_mass_of(scene, pair.a) + inverse_mass_of(scene, pair.b), motion.velocity.normal);
      total += now.viscous_force;
      if constexpr (kOn.energy_ledger) slots.viscous_force[k] = now.viscous_force;
    }
    slots.normal_force[k] = total;
    Vec2 force = total * normal;
    if constexpr (kOn.friction) {
      const double limit = scene.friction * total / kt;
      double shear = (known ? slots.shear_displacement[k] : 0.0) + motion.velocity.tangential * scene.dt;
      shear = std::abs(shear) > limit ? std::copysign(limit, shear) : shear;
      slots.shear_displacement[k] = shear;
      now.shear_force = -kt * shear;
      force += now.shear_force * common::perpendicular(normal);
    }
    ContactLoad& load = slots.load[k];
    load = {force, -common::cross(point - p.position[pair.a], force), common::cross(point - p.position[pair.b], force)};
    if constexpr (kOn.rolling_resistance) {
      now.rolling_moment = rolling_moment(known ? slots.rolling_moment[k] : 0.0, motion.spin * scene.dt, kr,
                                          scene.constants.rolling_friction * rolling_arm * total);
      slots.rolling_moment[k] = now.rolling_moment;
      load.moment_a -= now.rolling_moment;
      load.moment_b += now.rolling_moment;
    }
    if constexpr (kOn.energy_ledger) book_work<Law, kOn>(sums, before, now, motion, scene.dt, kt, kr);
  }
  return sums;
}

template <class Law, std::size_t... kIndex>
constexpr std::array<EvaluateContacts, kKernels> table_of(std::index_sequence<kIndex...>) {
  return {evaluate<Law, effects_at(kIndex)>...};
}

template <class Law>
ContactKernel kernel_of(const common::Effects& effects) {
  constexpr std::array<EvaluateContacts, kKernels> kTable = table_of<Law>(std::make_index_sequence<kKernels>());
  std::string name = Law::kName;
  if (effects.friction) name += " + friction";
  if (effects.contact_damping) name += " + contact_damping";
  if (effects.rolling_resistance) name += " + rolling_resistance";
  if (effects.energy_ledger) name += " + energy_ledger";
  return {kTable[index_of(effects)], Law::stiffness_bound, name};
}

}  // namespace

ContactKernel select_contact_kernel(common::ContactLaw law, const common::Effects& effects) {
  switch (law) {
    case common::ContactLaw::mean_depth:
      return kernel_of<MeanDepthLaw>(effects);
    case common::ContactLaw::area:
      return kernel_of<AreaLaw>(effects);
    case common::ContactLaw::foundation:
      return kernel_of<FoundationLaw>(effects);
    case common::ContactLaw::potential:
      break;
  }
  return kernel_of<PotentialLaw>(effects);
}

ContactConstants contact_constants(const common::Scene& scene) {
  ContactConstants c;
  c.normal_stiffness = scene.contact.normal_stiffness;
  c.length = scene.assembly.mean_diameter();
  const double stiffness =
      common::stiffness_is_per_area(scene.contact.law) ? 0.2 * c.normal_stiffness * c.length : c.normal_stiffness;
  c.tangential_stiffness = scene.contact.tangential_stiffness.value_or(stiffness);
  if (scene.effects.contact_damping) c.damping = scene.damping.contact;
  if (scene.effects.rolling_resistance) {
    c.rolling_friction = scene.contact.rolling_friction;
    c.rolling_stiffness = rolling_stiffness(stiffness, c.rolling_friction);
  }
  return c;
}

double elastic_energy(const State& state, const ContactConstants& constants) {
  double sum = 0;
  for (const Contact& c : state.contacts) {
    sum += c.elastic_normal + 0.5 * c.shear_force * c.shear_force / constants.tangential_stiffness;
    if (constants.rolling_stiffness == 0) continue;
    const double arm = rolling_radius(state.particles.area[c.a], state.particles.area[c.b]);
    sum += 0.5 * c.rolling_moment * c.rolling_moment / (constants.rolling_stiffness * arm * arm);
  }
  return sum;
}

void SlotsOfParticles::reset(std::size_t particles, const std::vector<Pair>& pairs) {
  offset_.assign(particles + 1, 0);
  for (const Pair& pair : pairs) {
    ++offset_[pair.a + 1];
    ++offset_[pair.b + 1];
  }
  for (std::size_t i = 0; i < particles; ++i) offset_[i + 1] += offset_[i];
  entry_.resize(2 * pairs.size());
  std::vector<std::uint32_t> next(offset_.begin(), offset_.end() - 1);
  for (std::uint32_t k = 0; k < pairs.size(); ++k) {
    entry_[next[pairs[k].a]++] = 2 * k;
    entry_[next[pairs[k].b]++] = 2 * k + 1;
  }
}

void SlotsOfParticles::gather(const std::vector<ContactLoad>& loads, std::size_t first, std::size_t last,
                              BodyForces& forces) const {
  for (std::size_t i = first; i < last; ++i) {
    Vec2 force = Vec2::Zero();
    double moment = 0;
    for (std::uint32_t e = offset_[i]; e < offset_[i + 1]; ++e) {
      const ContactLoad& load = loads[entry_[e] / 2];
      const bool is_b = entry_[e] & 1;
      force += is_b ? load.force : Vec2(-load.force);
      moment += is_b ? load.moment_b : load.moment_a;
    }
    forces.force[i] = force;
    forces.moment[i] = moment;
  }
}

}  // namespace dem
