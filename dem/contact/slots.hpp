// Contacts while they are evaluated: one slot for each pair that may touch, as arrays. An array that belongs to an
// effect is empty without it.
#pragma once

#include <cstdint>
#include <vector>

#include "common/config/scene.hpp"
#include "common/geometry/overlap.hpp"
#include "dem/neighbours.hpp"
#include "dem/state.hpp"

namespace dem {

/// What a contact does to its two particles; zero without overlap.
struct ContactLoad {
  Vec2 force = Vec2::Zero();  ///< on b [N]
  double moment_a = 0;        ///< about the centroid of a [N m]
  double moment_b = 0;
};

struct ContactSlots {
  std::vector<Pair> pair;  ///< S; ascending by (a, b)
  std::vector<common::PairFeature> feature;
  std::vector<double> overlap_area;   ///< [m^2]; 0: not in contact, and nothing else counts
  std::vector<double> overlap_width;  ///< [m]
  std::vector<Vec2> point;            ///< application point [m], world
  std::vector<Vec2> normal;           ///< unit, from a to b
  std::vector<double> normal_force;   ///< [N]
  std::vector<ContactLoad> load;
  std::vector<double> shear_displacement;  ///< friction: spring history [m]; the force is -kt times it
  std::vector<double> rolling_moment;      ///< rolling_resistance: history, the moment on b [N m]
  std::vector<double> elastic_normal;      ///< energy_ledger: state function of the normal law [J]
  std::vector<double> viscous_force;       ///< contact_damping with energy_ledger: part of normal_force [N]

  std::size_t size() const { return pair.size(); }

  /// Calls visit(name, array) for every array, also for the empty ones.
  template <class Visit>
  void for_each_array(const Visit& visit) const {
    visit("pair", pair);
    visit("feature", feature);
    visit("overlap area", overlap_area);
    visit("overlap width", overlap_width);
    visit("point", point);
    visit("normal", normal);
    visit("normal force", normal_force);
    visit("load", load);
    visit("shear displacement", shear_displacement);
    visit("rolling moment", rolling_moment);
    visit("elastic energy", elastic_normal);
    visit("viscous force", viscous_force);
  }

  /// Slots for other pairs; contacts that have a slot before and after keep all that belongs to them.
  void renew(const std::vector<Pair>& pairs, const common::Effects& effects);

  /// Takes over the histories of contacts, ascending by (a, b); those that have no slot are forgotten.
  void load_histories(const std::vector<Contact>& contacts);

  /// Writes the contacts in force, ascending by (a, b).
  void store(std::vector<Contact>& contacts, double tangential_stiffness) const;
};

}  // namespace dem
