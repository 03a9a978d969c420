// Oracle: a square lattice of unit squares, whose measures are known by hand.
#include <catch2/catch.hpp>

#include "dem/measures.hpp"

using dem::Vec2;

namespace {

/// 3 x 3 unit squares of area 0.5 on a unit lattice; the outer eight are the ring.
dem::State lattice() {
  dem::State state;
  auto& p = state.particles;
  const std::int32_t ring[] = {0, 1, 2, 5, 8, 7, 6, 3};
  for (int i = 0; i < 9; ++i) {
    p.id.push_back(i);
    p.position.push_back(Vec2(i % 3 + 100.0, i / 3 - 50.0));
    p.area.push_back(0.5);
    p.boundary.push_back(i != 4);
  }
  state.ring.assign(std::begin(ring), std::end(ring));
  return state;
}

}  // namespace

TEST_CASE("ring polygon and void ratios of a square lattice have their hand values") {
  dem::State state = lattice();
  CHECK(dem::ring_area(state) == Approx(4).epsilon(1e-14));
  // Inside: one whole particle, four halves at the sides, four quarters at the corners: 4 x 0.5 = 2 m^2.
  auto e = dem::void_ratios(state);
  CHECK(e.e1 == Approx(4 / 2.0 - 1).epsilon(1e-14));
  CHECK(e.e2 == Approx(e.e1).epsilon(1e-14));
  CHECK(e.e4 == Approx(4 / 0.5 - 1).epsilon(1e-14));
  dem::Contact contact;
  contact.a = 3;
  contact.b = 4;
  contact.overlap_area = 0.1;
  state.contacts.assign(2, contact);
  CHECK(dem::void_ratios(state).e2 == Approx(4 / 1.8 - 1).epsilon(1e-14));
}

TEST_CASE("a particle that has left the assembly counts in no void ratio, one that touches it does") {
  dem::State state = lattice();
  const auto whole = dem::void_ratios(state);
  auto& p = state.particles;
  for (const Vec2& at : {Vec2(110, -49), Vec2(101, -40), Vec2(90, -50), Vec2(99, -52)}) {
    p.id.push_back(static_cast<std::int64_t>(p.size()));
    p.position.push_back(at);
    p.area.push_back(0.5);
    p.boundary.push_back(0);
    const auto e = dem::void_ratios(state);
    CHECK(e.e1 == whole.e1);
    CHECK(e.e4 == whole.e4);
  }
  dem::Contact contact;
  contact.a = 8;
  contact.b = 9;
  state.contacts.push_back(contact);
  CHECK(dem::void_ratios(state).e4 == Approx(4 / 1.0 - 1).epsilon(1e-14));
}

TEST_CASE("interior angles above pi count as such") {
  dem::State state = lattice();
  state.particles.position[1] = Vec2(101.0, -49.5);  // a dent: angles 3 pi / 2 there
  const double pi = 3.14159265358979323846;
  const double at_dent = pi + 2 * std::atan(0.5);
  const double at_corner = pi / 2 - std::atan(0.5);
  const double rim = 0.5 * (at_dent + 2 * at_corner + 2 * pi / 2 + 3 * pi) / (2 * pi);
  CHECK(dem::ring_area(state) == Approx(3.5).epsilon(1e-14));
  CHECK(dem::void_ratios(state).e1 == Approx(3.5 / (0.5 + rim) - 1).epsilon(1e-13));
}

TEST_CASE("mean stress of a uniformly loaded lattice is the applied stress") {
  // Each vertical line of contacts carries 3 kN per 1 m of width, each horizontal one 2 kN; shear 0.5 kN both ways.
  dem::State state = lattice();
  const double area = 9;  // one cell for each particle; every particle has one contact to the right and one upward
  for (int repeat = 0; repeat < 9; ++repeat) {
    dem::Contact right;
    right.a = 3;
    right.b = 4;
    right.normal = Vec2(1, 0);
    right.normal_force = 2e3;
    right.shear_force = 500;
    dem::Contact up;
    up.a = 1;
    up.b = 4;
    up.normal = Vec2(0, 1);
    up.normal_force = 3e3;
    up.shear_force = -500;
    state.contacts.push_back(right);
    state.contacts.push_back(up);
  }
  const auto stress = dem::mean_stress(state, area);
  CHECK(stress[0] == Approx(2e3));
  CHECK(stress[1] == Approx(3e3));
  CHECK(stress[2] == Approx(500));
}
