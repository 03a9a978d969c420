#include <fmt/format.h>

#include "common/geometry/center.hpp"
#include "common/geometry/chord_split.hpp"
#include "common/io/split.hpp"
#include "dem/fragments.hpp"
#include "tests/fuzz/draws.hpp"
#include "tests/unit/dem/bodies.hpp"

namespace fuzz {
namespace {

using common::Polygon;
using common::Vec2;

Vec2 chord_end(Draws& draws, const Polygon& outline, double size) {
  const std::size_t edge = draws.byte() % outline.size();
  const double t = draws.one_in(4) ? std::ldexp(1, -draws.integer(0, 60)) : draws.unit();
  Vec2 end = outline[edge] + t * (outline[(edge + 1) % outline.size()] - outline[edge]);
  if (draws.one_in(4)) end += size * Vec2{draws.magnitude(-60, -18), draws.magnitude(-60, -18)};
  return end;
}

/// Share of the parent's area that the pieces may miss.
double area_share(const Polygon& outline) {
  const double size = common::diameter(outline);
  return 1e-12 + 1e-15 * size * size / common::area(outline);
}

void check_pieces(const Polygon& outline, const common::ChordSplit& pieces) {
  for (const Polygon* piece : {&pieces.left, &pieces.right}) {
    const std::string defect = common::outline_defect(*piece);
    if (!defect.empty()) wrong("a piece: " + defect);
  }
  const double whole = common::area(outline);
  const double sum = common::area(pieces.left) + common::area(pieces.right);
  if (!(std::abs(sum - whole) <= area_share(outline) * whole)) {
    wrong(fmt::format("the pieces have {:.17g} of {:.17g} m^2", sum, whole));
  }
  int shared = 0;
  for (const Vec2& p : pieces.left) {
    for (const Vec2& q : pieces.right) shared += p == q;
  }
  require(shared == 2, "the pieces share other than two vertices");
}

/// The particle among neighbours that it touches, broken as the pieces say.
void check_fragments(Draws& draws, const Polygon& outline, const common::ChordSplit& pieces, double size) {
  dem::State state;
  state.next_id = draws.byte();
  const int before = draws.integer(0, 3), after = draws.integer(0, 3);
  const auto add_neighbour = [&] {
    bodies::add(state, bodies::box(size, size), size * Vec2{draws.uniform(-3, 3), draws.uniform(-3, 3)});
    state.particles.boundary.back() = draws.flag();
  };
  for (int k = 0; k < before; ++k) add_neighbour();
  const Vec2 at = size * Vec2{draws.uniform(-1, 1), draws.uniform(-1, 1)};
  bodies::add(state, outline, at, draws.uniform(-7, 7));
  for (int k = 0; k < after; ++k) add_neighbour();
  auto& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.velocity[i] = Vec2{draws.uniform(-1, 1), draws.uniform(-1, 1)};
    p.angular_velocity[i] = draws.uniform(-10, 10);
    for (std::size_t j = i + 1; j < p.size(); ++j) {
      if (!draws.flag()) continue;
      dem::Contact contact;
      contact.a = static_cast<std::int32_t>(i);
      contact.b = static_cast<std::int32_t>(j);
      contact.normal = Vec2(1, 0);
      contact.shear_displacement = draws.uniform(-1, 1);
      state.contacts.push_back(contact);
    }
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.boundary[i]) state.ring.push_back(static_cast<std::int32_t>(i));
  }

  common::Split split;
  const std::int64_t parent = p.id[before];
  split.broken.parent = {parent};
  split.broken.path = {{pieces.left.back(), pieces.left.front()}};
  split.fragments.id = {state.next_id, state.next_id + 1 + draws.integer(0, 2)};
  split.fragments.parent = {parent, parent};
  split.fragments.vertices = pieces.left;
  split.fragments.vertex_offset = {0, static_cast<std::int64_t>(pieces.left.size())};
  split.fragments.vertices.insert(split.fragments.vertices.end(), pieces.right.begin(), pieces.right.end());
  split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));

  const bodies::Sums old = bodies::sums(p);
  const std::size_t particles = p.size();
  double moved = 0;  // what the momentum is made of
  for (std::size_t i = 0; i < particles; ++i) {
    moved += p.mass[i] * (p.velocity[i].norm() + std::abs(p.angular_velocity[i]) * size);
  }
  const double share = area_share(outline);
  dem::SplitReport report;
  if (!unless_refused([&] { report = dem::apply_split(state, split, bodies::kDensity); })) {
    return require(share > 1e-9, "fragments that fill their parent are refused");
  }
  const bodies::Sums now = bodies::sums(p);
  require(report.broken == 1 && p.size() == particles + 1, "one particle breaks into two");
  require(report.area_error <= share, "area of the fragments");
  // Velocities are those of the parent at the fragments' centroids, so the momentum is out by density * w * sum(A c),
  // which is 0 if c are exact and the parent's is the origin: to 1.6e-13 D (center_of) and rounding of D^3 / A in each
  // centroid.
  require((now.momentum - old.momentum).norm() <= share * moved, "momentum of the fragments");
  require(std::abs(now.mass - old.mass) <= share * old.mass, "mass of the fragments");
  require(std::abs(now.kinetic_energy - old.kinetic_energy) <= (1e-10 + 10 * share) * old.kinetic_energy,
          "energy of the fragments");
  for (std::size_t i = 1; i < p.size(); ++i) require(p.id[i] > p.id[i - 1], "ids do not ascend");
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::string defect = common::outline_defect(p.outline(i));
    if (!defect.empty()) wrong("outline of a particle after the split: " + defect);
  }
  for (const dem::Contact& contact : state.contacts) {
    require(contact.a >= 0 && contact.a < contact.b && contact.b < static_cast<int>(p.size()), "indices of a contact");
  }
  for (auto& contact : state.contacts) contact.normal_force = draws.unit();
  dem::share_inherited_history(state, report);
  for (const auto& contact : state.contacts) require(std::isfinite(contact.shear_displacement), "history of a heir");
}

}  // namespace

void chord(Input input) {
  Draws draws(input);
  Polygon outline = draws.polygon(32);
  const double scale = draws.one_in(8) ? std::ldexp(1, draws.integer(-20, 20)) : draws.uniform(0.05, 0.5);
  for (Vec2& v : outline) v *= scale;
  if (!common::outline_defect(outline).empty()) return;
  const common::Center center = common::center_of(outline);
  for (Vec2& v : outline) v = center.to(v);
  if (!common::outline_defect(outline).empty()) return;
  const double size = common::diameter(outline);
  const Vec2 first = chord_end(draws, outline, size), last = chord_end(draws, outline, size);
  common::ChordSplit pieces;
  if (!unless_refused([&] { pieces = common::split_by_chord(outline, first, last); })) return;
  check_pieces(outline, pieces);
  check_fragments(draws, outline, pieces, size);
}

}  // namespace fuzz
