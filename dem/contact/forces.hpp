// Forces of all contacts at one instant: overlap -> normal law -> Coulomb friction with history -> particle sums.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/config/scene.hpp"
#include "dem/contact/laws.hpp"
#include "dem/state.hpp"

namespace dem {

/// Two particles that may touch before the next rebuild; indices, a < b; a pair list ascends by (a, b).
struct Pair {
  std::int32_t a, b;
};

/// Resultant contact force and moment on each particle.
struct BodyForces {
  std::vector<Vec2> force;     ///< N [N]
  std::vector<double> moment;  ///< N, about the centroid [N m]
};

/// World outlines, parallel to Particles::vertices, and bounding radii.
struct WorldOutlines {
  std::vector<Vec2> vertices;  ///< V [m]
  std::vector<double> radius;  ///< N; of the circle about the centroid [m]
};

/// What a contact evaluation takes and leaves behind.
struct ContactWork {
  std::vector<Pair> pairs;
  WorldOutlines outlines;
  BodyForces forces;
  std::vector<Contact> previous;  ///< contacts of the instant before; the buffers swap
  std::int64_t sliding = 0;       ///< contacts at the Coulomb limit
};

/// Evaluates the contacts of `work.pairs` at the state's positions. Shear histories advance by the relative velocity
/// at the contact point (at t - dt/2) times `dt`; dt = 0 re-evaluates forces without any slip. Ring-ring pairs are
/// left out (DESIGN section 2, Boundary). Adds friction and contact-law work to state.energy if the ledger is on.
///
/// Tangential: Cundall & Strack 1979, t = -kt u, |t| <= mu N. Work is integrated by the trapezoidal rule over the
/// step that led here, so that friction = work - change of elastic energy holds to rounding.
using EvaluateContacts = void (*)(State& state, ContactWork& work, const ContactConstants& constants, double dt);

struct ContactKernel {
  EvaluateContacts evaluate;
  double (*stiffness_bound)(double edge, const ContactConstants& constants);
  std::string name;  ///< for `explain`, e.g. "area + friction + energy_ledger"
};

/// The kernel of a scene, from a constexpr table: what the scene does not name is not in the compiled loop.
ContactKernel select_contact_kernel(common::ContactLaw law, const common::Effects& effects);

/// Contact constants of a scene. An absent tangential stiffness is kn for mean_depth and potential, and
/// 0.2 kA L for the area law (the slope of a contact a fifth of a diameter wide).
ContactConstants contact_constants(const common::Scene& scene);

/// Elastic energy stored in the contacts in force [J].
double elastic_energy(const State& state, const ContactConstants& constants);

}  // namespace dem
