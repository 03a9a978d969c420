// Forces of all contacts at one instant: overlap -> normal law -> effects of the contact (damping, Coulomb friction and
// rolling resistance with their histories) -> load on the two particles; then the resultant on each particle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/scene.hpp"
#include "dem/contact/laws.hpp"
#include "dem/contact/slots.hpp"
#include "dem/outlines.hpp"
#include "dem/state.hpp"

namespace dem {

/// Resultant contact force and moment on each particle.
struct BodyForces {
  std::vector<Vec2> force;     ///< N [N]
  std::vector<double> moment;  ///< N, about the centroid [N m]
};

/// What the contacts of one instant do in sum. The works are zero without the energy ledger.
struct ContactSums {
  std::int64_t contacts = 0;
  double friction = 0;          ///< dissipated by friction in the step that led here [J]
  double contact_damping = 0;   ///< dissipated by contact damping [J]
  double rolling = 0;           ///< dissipated by rolling resistance [J]
  double contact_law_work = 0;  ///< path-dependent work of the normal law [J]

  ContactSums& operator+=(const ContactSums& o) {
    contacts += o.contacts;
    friction += o.friction;
    contact_damping += o.contact_damping;
    rolling += o.rolling;
    contact_law_work += o.contact_law_work;
    return *this;
  }
};

/// What the evaluation of contacts needs to know besides the slots.
struct ContactScene {
  const Particles& particles;
  const WorldOutlines& outlines;
  const std::vector<double>& inverse_mass;  ///< N [1/kg]
  const ContactConstants& constants;
  double friction;  ///< coefficient in force
  double dt;        ///< time since the last evaluation [s]; 0 re-evaluates the forces without any slip
};

/// Evaluates slots first..last-1. Shear histories advance by the relative velocity at the contact point (at t - dt/2)
/// times dt.
///
/// Tangential: Cundall & Strack 1979, t = -kt u, |t| <= mu N. Work is integrated by the trapezoidal rule over the
/// step that led here, so that friction = work - change of elastic energy holds to rounding.
using EvaluateContacts = ContactSums (*)(const ContactScene& scene, ContactSlots& slots, std::size_t first,
                                         std::size_t last);

struct ContactKernel {
  EvaluateContacts evaluate;
  double (*stiffness_bound)(double edge, const ContactConstants& constants);
  std::string name;  ///< for `explain`, e.g. "area + friction + energy_ledger"
};

/// The kernel of a scene, from a constexpr table: what the scene does not name is not in the compiled loop.
ContactKernel select_contact_kernel(common::ContactLaw law, const common::Effects& effects);

/// Contact constants of a scene. An absent tangential stiffness is kn for mean_depth and potential, and
/// 0.2 k L for area and foundation (the slope of a contact a fifth of a diameter wide).
ContactConstants contact_constants(const common::Scene& scene);

/// Elastic energy stored in the contacts in force [J].
double elastic_energy(const State& state, const ContactConstants& constants);

/// The slots of each particle, so that resultants are gathered in the same order by any number of threads.
class SlotsOfParticles {
 public:
  void reset(std::size_t particles, const std::vector<Pair>& pairs);

  /// Writes the resultants on particles first..last-1.
  void gather(const std::vector<ContactLoad>& loads, std::size_t first, std::size_t last, BodyForces& forces) const;

 private:
  std::vector<std::uint32_t> offset_;
  std::vector<std::uint32_t> entry_;  ///< slot * 2, + 1 where the particle is b
};

}  // namespace dem
