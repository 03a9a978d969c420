#include "dem/contact/forces.hpp"

#include <cmath>

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

// Forces and stored energy of a contact at one instant; all zero without overlap.
struct Instant {
  double normal_force = 0, shear_force = 0, elastic_normal = 0;
};

// Energies of the step from `before` to `now`.
template <class Law, bool kFriction>
void book_work(ContactSums& sums, const Instant& before, const Instant& now, const RelativeVelocity& v, double dt,
               double kt) {
  if constexpr (!Law::kGradient) {
    const double work = -0.5 * (before.normal_force + now.normal_force) * v.normal * dt;
    sums.contact_law_work += work - (now.elastic_normal - before.elastic_normal);
  }
  if constexpr (kFriction) {
    const double work = -0.5 * (before.shear_force + now.shear_force) * v.tangential * dt;
    const double stored = 0.5 * (now.shear_force * now.shear_force - before.shear_force * before.shear_force) / kt;
    sums.friction += work - stored;
  }
}

template <class Law, bool kFriction, bool kLedger>
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

    Instant before;
    if constexpr (kLedger) {
      if (known) {
        before.normal_force = slots.normal_force[k];
        before.elastic_normal = slots.elastic_normal[k];
        if constexpr (kFriction) before.shear_force = -kt * slots.shear_displacement[k];
      }
    }
    slots.overlap_area[k] = o.area;
    if (!(o.area > 0)) {
      if constexpr (kLedger) {
        const RelativeVelocity v = relative_velocity(p, pair, slots.point[k], slots.normal[k]);
        book_work<Law, kFriction>(sums, before, {}, v, scene.dt, kt);
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
    slots.normal_force[k] = now.normal_force;
    if constexpr (kLedger) slots.elastic_normal[k] = now.elastic_normal = action.energy;

    Vec2 force = now.normal_force * normal;
    if constexpr (kFriction || (kLedger && !Law::kGradient)) {
      const RelativeVelocity v = relative_velocity(p, pair, point, normal);
      if constexpr (kFriction) {
        const double limit = scene.friction * now.normal_force / kt;
        double shear = (known ? slots.shear_displacement[k] : 0.0) + v.tangential * scene.dt;
        const bool slides = std::abs(shear) > limit;
        shear = slides ? std::copysign(limit, shear) : shear;
        sums.sliding += slides;
        slots.shear_displacement[k] = shear;
        now.shear_force = -kt * shear;
        force += now.shear_force * common::perpendicular(normal);
      }
      if constexpr (kLedger) book_work<Law, kFriction>(sums, before, now, v, scene.dt, kt);
    }
    slots.load[k] = {force, -common::cross(point - p.position[pair.a], force),
                     common::cross(point - p.position[pair.b], force)};
  }
  return sums;
}

template <class Law>
ContactKernel kernel_of(const common::Effects& effects) {
  constexpr EvaluateContacts kTable[2][2] = {{evaluate<Law, false, false>, evaluate<Law, false, true>},
                                             {evaluate<Law, true, false>, evaluate<Law, true, true>}};
  std::string name = Law::kName;
  if (effects.friction) name += " + friction";
  if (effects.energy_ledger) name += " + energy_ledger";
  return {kTable[effects.friction][effects.energy_ledger], Law::stiffness_bound, name};
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
  c.length = 0.5 * (scene.assembly.diameter_min + scene.assembly.diameter_max);
  c.tangential_stiffness = scene.contact.tangential_stiffness.value_or(
      common::stiffness_is_per_area(scene.contact.law) ? 0.2 * c.normal_stiffness * c.length : c.normal_stiffness);
  return c;
}

double elastic_energy(const State& state, const ContactConstants& constants) {
  double sum = 0;
  for (const Contact& c : state.contacts) {
    sum += c.elastic_normal + 0.5 * c.shear_force * c.shear_force / constants.tangential_stiffness;
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
