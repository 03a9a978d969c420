#include "dem/contact/forces.hpp"

#include <cmath>

namespace dem {
namespace {

struct RelativeVelocity {
  double normal, tangential;
};

RelativeVelocity relative_velocity(const Particles& p, const Contact& c) {
  const Vec2 arm_a = c.point - p.position[c.a];
  const Vec2 arm_b = c.point - p.position[c.b];
  const Vec2 v = p.velocity[c.b] + p.angular_velocity[c.b] * common::perpendicular(arm_b) - p.velocity[c.a] -
                 p.angular_velocity[c.a] * common::perpendicular(arm_a);
  return {v.dot(c.normal), v.dot(common::perpendicular(c.normal))};
}

// Shear spring and Coulomb limit. Returns true if the contact slides.
bool apply_friction(Contact& c, double trial_displacement, double friction, double kt) {
  const double limit = friction * c.normal_force;
  c.shear_displacement = trial_displacement;
  c.shear_force = -kt * trial_displacement;
  if (std::abs(c.shear_force) <= limit) return false;
  c.shear_force = std::copysign(limit, c.shear_force);
  c.shear_displacement = -c.shear_force / kt;
  return true;
}

// Energies of the step from `before` to `now`; `before` without overlap has all forces zero.
template <class Law, bool kFriction>
void book_work(EnergySums& energy, const Contact& before, const Contact& now, const RelativeVelocity& v, double dt,
               double kt) {
  if constexpr (!Law::kGradient) {
    const double work = -0.5 * (before.normal_force + now.normal_force) * v.normal * dt;
    energy.contact_law_work += work - (now.elastic_normal - before.elastic_normal);
  }
  if constexpr (kFriction) {
    const double work = -0.5 * (before.shear_force + now.shear_force) * v.tangential * dt;
    const double stored = 0.5 * (now.shear_force * now.shear_force - before.shear_force * before.shear_force) / kt;
    energy.friction += work - stored;
  }
}

void add_forces(BodyForces& sums, const Particles& p, const Contact& c) {
  const Vec2 f = c.force();
  sums.force[c.a] -= f;
  sums.force[c.b] += f;
  sums.moment[c.a] -= common::cross(c.point - p.position[c.a], f);
  sums.moment[c.b] += common::cross(c.point - p.position[c.b], f);
}

template <class Law, bool kFriction, bool kLedger>
void evaluate(State& state, ContactWork& work, const ContactConstants& constants, double dt) {
  const Particles& p = state.particles;
  work.previous.swap(state.contacts);
  state.contacts.clear();
  work.sliding = 0;
  work.forces.force.assign(p.size(), Vec2::Zero());
  work.forces.moment.assign(p.size(), 0.0);

  const auto outline = [&](std::int32_t i) {
    const auto first = p.vertex_offset[i];
    return PolygonView(work.outlines.vertices.data() + first, static_cast<std::size_t>(p.vertex_offset[i + 1] - first));
  };
  const auto end_contact = [&](const Contact& before) {
    if constexpr (kLedger) {
      Contact gone = before;
      gone.normal_force = gone.shear_force = gone.elastic_normal = 0;
      book_work<Law, kFriction>(state.energy, before, gone, relative_velocity(p, before), dt,
                                constants.tangential_stiffness);
    }
  };

  auto before = work.previous.cbegin();
  const auto last = work.previous.cend();
  for (const Pair& pair : work.pairs) {
    while (before != last && (before->a < pair.a || (before->a == pair.a && before->b < pair.b)))
      end_contact(*before++);
    const bool known = before != last && before->a == pair.a && before->b == pair.b;
    const Contact* history = known ? &*before++ : nullptr;

    const double reach = work.outlines.radius[pair.a] + work.outlines.radius[pair.b];
    Overlap o;
    if ((p.position[pair.b] - p.position[pair.a]).squaredNorm() < reach * reach &&
        !(p.boundary[pair.a] && p.boundary[pair.b])) {
      o = common::overlap(outline(pair.a), outline(pair.b));
    }
    if (o.area <= 0) {
      if (history) end_contact(*history);
      continue;
    }

    Contact c;
    c.a = pair.a;
    c.b = pair.b;
    c.point = Law::point(o);
    c.normal = o.normal;
    c.overlap_area = o.area;
    c.overlap_width = o.width;
    c.normal_force = Law::force(o, constants);
    if constexpr (kLedger) c.elastic_normal = Law::energy(o, constants);
    if constexpr (kFriction || kLedger) {
      const RelativeVelocity v = relative_velocity(p, c);
      if constexpr (kFriction) {
        const double trial = (history ? history->shear_displacement : 0.0) + v.tangential * dt;
        work.sliding += apply_friction(c, trial, state.friction, constants.tangential_stiffness);
      }
      if constexpr (kLedger) {
        Contact none;
        book_work<Law, kFriction>(state.energy, history ? *history : none, c, v, dt, constants.tangential_stiffness);
      }
    }
    add_forces(work.forces, p, c);
    state.contacts.push_back(c);
  }
  while (before != last) end_contact(*before++);
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
    case common::ContactLaw::potential:
      break;
  }
  return kernel_of<PotentialLaw>(effects);
}

ContactConstants contact_constants(const common::Scene& scene) {
  ContactConstants c;
  c.normal_stiffness = scene.contact.normal_stiffness;
  c.length = 0.5 * (scene.assembly.diameter_min + scene.assembly.diameter_max);
  const bool area_law = scene.contact.law == common::ContactLaw::area;
  c.tangential_stiffness =
      scene.contact.tangential_stiffness.value_or(area_law ? 0.2 * c.normal_stiffness * c.length : c.normal_stiffness);
  return c;
}

double elastic_energy(const State& state, const ContactConstants& constants) {
  double sum = 0;
  for (const Contact& c : state.contacts) {
    sum += c.elastic_normal + 0.5 * c.shear_force * c.shear_force / constants.tangential_stiffness;
  }
  return sum;
}

}  // namespace dem
