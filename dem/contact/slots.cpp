#include "dem/contact/slots.hpp"

namespace dem {
namespace {

constexpr std::int64_t kNone = -1;

bool before(const Pair& l, const Pair& r) {
  return l.a != r.a ? l.a < r.a : l.b < r.b;
}

template <class T>
void pick(std::vector<T>& values, const std::vector<std::int64_t>& from, const T& otherwise) {
  const std::vector<T> old = std::move(values);
  values.assign(from.size(), otherwise);
  for (std::size_t k = 0; k < from.size(); ++k) {
    if (from[k] != kNone) values[k] = old[static_cast<std::size_t>(from[k])];
  }
}

}  // namespace

void ContactSlots::renew(const std::vector<Pair>& pairs, const common::Effects& effects) {
  std::vector<std::int64_t> from(pairs.size(), kNone);
  std::size_t old = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    while (old < pair.size() && before(pair[old], pairs[k])) ++old;
    if (old < pair.size() && !before(pairs[k], pair[old])) from[k] = static_cast<std::int64_t>(old);
  }
  pair = pairs;
  const Vec2 zero = Vec2::Zero();
  pick(feature, from, {});
  pick(overlap_area, from, 0.0);
  pick(overlap_width, from, 0.0);
  pick(point, from, zero);
  pick(normal, from, zero);
  pick(normal_force, from, 0.0);
  pick(load, from, {});
  if (effects.friction) pick(shear_displacement, from, 0.0);
  if (effects.rolling_resistance) pick(rolling_moment, from, 0.0);
  if (effects.energy_ledger) pick(elastic_normal, from, 0.0);
  if (effects.contact_damping && effects.energy_ledger) pick(viscous_force, from, 0.0);
}

void ContactSlots::load_histories(const std::vector<Contact>& contacts) {
  std::size_t k = 0;
  for (const Contact& c : contacts) {
    while (k < size() && before(pair[k], {c.a, c.b})) ++k;
    if (k == size()) return;
    if (before({c.a, c.b}, pair[k])) continue;
    overlap_area[k] = c.overlap_area;
    normal_force[k] = c.normal_force;
    if (!shear_displacement.empty()) shear_displacement[k] = c.shear_displacement;
    if (!rolling_moment.empty()) rolling_moment[k] = c.rolling_moment;
    if (!elastic_normal.empty()) elastic_normal[k] = c.elastic_normal;
  }
}

void ContactSlots::store(std::vector<Contact>& contacts, double tangential_stiffness) const {
  contacts.clear();
  for (std::size_t k = 0; k < size(); ++k) {
    if (!(overlap_area[k] > 0)) continue;
    Contact c;
    c.a = pair[k].a;
    c.b = pair[k].b;
    c.point = point[k];
    c.normal = normal[k];
    c.normal_force = normal_force[k];
    c.overlap_area = overlap_area[k];
    c.overlap_width = overlap_width[k];
    if (!shear_displacement.empty()) {
      c.shear_displacement = shear_displacement[k];
      c.shear_force = -tangential_stiffness * shear_displacement[k];
    }
    if (!rolling_moment.empty()) c.rolling_moment = rolling_moment[k];
    if (!elastic_normal.empty()) c.elastic_normal = elastic_normal[k];
    contacts.push_back(c);
  }
}

}  // namespace dem
