#include "dem/fragments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/error.hpp"

namespace dem {
namespace {

constexpr double kAreaTolerance = 1e-9;

/// Sums over particles that a split conserves.
struct Totals {
  double area = 0;
  double kinetic_energy = 0;
  double momentum_sizes = 0;
  Vec2 momentum = Vec2::Zero();

  void add(const Particles& p, std::size_t i) {
    area += p.area[i];
    kinetic_energy +=
        0.5 * (p.mass[i] * p.velocity[i].squaredNorm() + p.inertia[i] * p.angular_velocity[i] * p.angular_velocity[i]);
    momentum += p.mass[i] * p.velocity[i];
    momentum_sizes += p.mass[i] * p.velocity[i].norm();
  }
};

PolygonView outline_of(const common::Split& split, std::size_t fragment) {
  const auto first = split.fragments.vertex_offset[fragment];
  const auto last = split.fragments.vertex_offset[fragment + 1];
  return {split.fragments.vertices.data() + first, static_cast<std::size_t>(last - first)};
}

/// Fragments of each broken particle: parent's index -> positions in split.fragments.
struct Family {
  std::int32_t parent;
  std::array<std::size_t, 2> fragments;
};

std::vector<Family> check_families(const State& state, const common::Split& split) {
  const auto refuse = [&](const std::string& text) {
    return common::bad_input(fmt::format("split of frame {}: {}", split.frame, text));
  };
  const Particles& p = state.particles;
  const auto& fragments = split.fragments;
  if (fragments.id.size() != 2 * split.broken.parent.size() || fragments.parent.size() != fragments.id.size() ||
      fragments.vertex_offset.size() != fragments.id.size() + 1) {
    throw refuse(fmt::format("{} fragments for {} broken particles, expected two for each", fragments.id.size(),
                             split.broken.parent.size()));
  }
  std::vector<Family> families;
  for (std::size_t m = 0; m < split.broken.parent.size(); ++m) {
    const std::int64_t id = split.broken.parent[m];
    const auto found = std::lower_bound(p.id.begin(), p.id.end(), id);
    if (found == p.id.end() || *found != id) throw refuse(fmt::format("broken particle {} does not exist", id));
    const auto parent = static_cast<std::size_t>(found - p.id.begin());
    if (p.boundary[parent]) throw refuse(fmt::format("particle {} is a boundary particle and cannot break", id));
    double area = 0;
    for (const std::size_t f : {2 * m, 2 * m + 1}) {
      if (fragments.parent[f] != id) {
        throw refuse(fmt::format("fragment {} has parent {}, expected {}", fragments.id[f], fragments.parent[f], id));
      }
      if (fragments.id[f] < state.next_id || (f > 0 && fragments.id[f] <= fragments.id[f - 1])) {
        throw refuse(fmt::format("fragment id {} is taken or out of order, expected ascending ids from {}",
                                 fragments.id[f], state.next_id));
      }
      const std::string defect = common::outline_defect(outline_of(split, f));
      if (!defect.empty()) throw refuse(fmt::format("outline of fragment {}: {}", fragments.id[f], defect));
      area += common::area(outline_of(split, f));
    }
    if (!(std::abs(area - p.area[parent]) <= kAreaTolerance * p.area[parent])) {
      throw refuse(
          fmt::format("the fragments of particle {} have an area of {} m^2, expected {}", id, area, p.area[parent]));
    }
    families.push_back({static_cast<std::int32_t>(parent), {2 * m, 2 * m + 1}});
  }
  std::vector<std::int32_t> parents;
  for (const Family& family : families) parents.push_back(family.parent);
  std::sort(parents.begin(), parents.end());
  const auto twice = std::adjacent_find(parents.begin(), parents.end());
  if (twice != parents.end())
    throw refuse(fmt::format("particle {} breaks twice", p.id[static_cast<std::size_t>(*twice)]));
  return families;
}

void append_copy(Particles& to, const Particles& from, std::size_t i) {
  to.id.push_back(from.id[i]);
  to.parent.push_back(from.parent[i]);
  to.root.push_back(from.root[i]);
  to.generation.push_back(from.generation[i]);
  to.type.push_back(from.type[i]);
  to.position.push_back(from.position[i]);
  to.velocity.push_back(from.velocity[i]);
  to.displacement.push_back(from.displacement[i]);
  to.angle.push_back(from.angle[i]);
  to.angular_velocity.push_back(from.angular_velocity[i]);
  to.mass.push_back(from.mass[i]);
  to.inertia.push_back(from.inertia[i]);
  to.area.push_back(from.area[i]);
  to.boundary.push_back(from.boundary[i]);
  const PolygonView outline = from.outline(i);
  to.vertices.insert(to.vertices.end(), outline.begin(), outline.end());
  to.vertex_offset.push_back(static_cast<std::int64_t>(to.vertices.size()));
}

void append_fragment(Particles& to, const Particles& from, std::size_t parent, std::int64_t id, PolygonView outline,
                     double density) {
  const Vec2 center = common::centroid(outline);
  const Vec2 arm = common::Rotation(from.angle[parent]) * center;
  const double area = common::area(outline);
  to.id.push_back(id);
  to.parent.push_back(from.id[parent]);
  to.root.push_back(from.root[parent]);
  to.generation.push_back(from.generation[parent] + 1);
  to.type.push_back(-1);
  to.position.push_back(from.position[parent] + arm);
  to.velocity.push_back(from.velocity[parent] + from.angular_velocity[parent] * common::perpendicular(arm));
  to.displacement.push_back(from.displacement[parent]);
  to.angle.push_back(from.angle[parent]);
  to.angular_velocity.push_back(from.angular_velocity[parent]);
  to.mass.push_back(density * area);
  to.inertia.push_back(density * common::polar_moment(outline));
  to.area.push_back(area);
  to.boundary.push_back(0);
  for (const Vec2& vertex : outline) to.vertices.push_back(vertex - center);
  to.vertex_offset.push_back(static_cast<std::int64_t>(to.vertices.size()));
}

}  // namespace

SplitReport apply_split(State& state, const common::Split& split, double density) {
  const std::vector<Family> families = check_families(state, split);
  SplitReport report;
  report.broken = static_cast<int>(families.size());
  if (families.empty()) return report;

  // Heirs of each particle: itself under its new index, or its fragments.
  const Particles& old = state.particles;
  std::vector<std::array<std::int32_t, 2>> heirs(old.size(), {-1, -1});
  std::vector<std::uint8_t> broken(old.size(), 0);
  for (const Family& family : families) broken[family.parent] = 1;

  Totals before, after, all;
  Particles particles;
  for (std::size_t i = 0; i < old.size(); ++i) {
    all.add(old, i);
    if (broken[i]) continue;
    heirs[i][0] = static_cast<std::int32_t>(particles.size());
    append_copy(particles, old, i);
  }
  for (const Family& family : families) {
    before.add(old, family.parent);
    for (int k = 0; k < 2; ++k) {
      heirs[family.parent][k] = static_cast<std::int32_t>(particles.size());
      const std::size_t f = family.fragments[k];
      append_fragment(particles, old, family.parent, split.fragments.id[f], outline_of(split, f), density);
      after.add(particles, particles.size() - 1);
    }
  }

  std::vector<Contact> contacts;
  std::int32_t group = 0;
  for (const Contact& contact : state.contacts) {
    const bool inherited = broken[contact.a] || broken[contact.b];
    for (const std::int32_t a : heirs[contact.a]) {
      for (const std::int32_t b : heirs[contact.b]) {
        if (a < 0 || b < 0) continue;
        Contact heir = contact;
        heir.a = std::min(a, b);
        heir.b = std::max(a, b);
        // The force on b along (-n_y, n_x) is the same number from either side.
        if (a > b) heir.normal = -heir.normal;
        if (inherited) heir.rolling_moment = 0;  // a fragment has not rolled yet
        contacts.push_back(heir);
        if (inherited) report.inherited.push_back({heir.a, heir.b, group, contact.shear_displacement});
      }
    }
    group += inherited;
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& l, const Contact& r) { return l.a < r.a || (l.a == r.a && l.b < r.b); });

  for (std::int32_t& i : state.ring) i = heirs[i][0];
  state.contacts = std::move(contacts);
  state.particles = std::move(particles);
  state.next_id = state.particles.id.back() + 1;

  if (all.momentum_sizes > 0) report.momentum_error = (after.momentum - before.momentum).norm() / all.momentum_sizes;
  report.kinetic_energy_change = after.kinetic_energy - before.kinetic_energy;
  report.area_error = std::abs(after.area - before.area) / all.area;
  return report;
}

void share_inherited_history(State& state, const SplitReport& report) {
  const auto find = [&](const InheritedContact& heir) -> Contact* {
    const auto at = std::lower_bound(
        state.contacts.begin(), state.contacts.end(), heir,
        [](const Contact& c, const InheritedContact& h) { return c.a < h.a || (c.a == h.a && c.b < h.b); });
    return at != state.contacts.end() && at->a == heir.a && at->b == heir.b ? &*at : nullptr;
  };
  for (auto first = report.inherited.begin(); first != report.inherited.end();) {
    const auto last = std::find_if(first, report.inherited.end(),
                                   [&](const InheritedContact& heir) { return heir.group != first->group; });
    double sum = 0;
    for (auto heir = first; heir != last; ++heir) {
      if (const Contact* contact = find(*heir)) sum += contact->normal_force;
    }
    for (auto heir = first; heir != last; ++heir) {
      Contact* contact = find(*heir);
      if (contact && sum > 0) contact->shear_displacement = heir->shear_displacement * (contact->normal_force / sum);
    }
    first = last;
  }
}

}  // namespace dem
