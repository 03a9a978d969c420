// Oracle: a square lattice of unit squares, whose measures are known by hand.
#include <catch2/catch.hpp>
#include <cmath>

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
  CHECK(whole.escaped == 0);
  int gone = 0;
  auto& p = state.particles;
  for (const Vec2& at : {Vec2(110, -49), Vec2(101, -40), Vec2(90, -50), Vec2(99, -52)}) {
    p.id.push_back(static_cast<std::int64_t>(p.size()));
    p.position.push_back(at);
    p.area.push_back(0.5);
    p.boundary.push_back(0);
    const auto e = dem::void_ratios(state);
    CHECK(e.escaped == ++gone);
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

TEST_CASE("interior stress is the average along the branches inside an ellipse of 0.7 of the ring's axes") {
  // A square lattice of n x n points, twice as high as wide, one contact to the right and one upward of each point but
  // the last. Forces are 3 N/m times the width of a lattice line, growing along x: stress_yy = 3 (1 + x / 10) at x.
  constexpr int n = 81;
  dem::State state;
  auto& p = state.particles;
  const auto index = [](int column, int row) { return static_cast<std::int32_t>(row * n + column); };
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      p.id.push_back(index(column, row));
      p.position.push_back(Vec2(0.25 * (column - 40) + 7, 0.5 * (row - 40) - 3));
      p.area.push_back(0.1);
      p.boundary.push_back(0);
    }
  }
  // The extreme points of an ellipse of semi-axes 10 and 20.
  state.ring = {index(40, 0), index(80, 40), index(40, 80), index(0, 40)};
  const auto add = [&](std::int32_t a, std::int32_t b, const Vec2& normal, double force) {
    dem::Contact contact;
    contact.a = a;
    contact.b = b;
    contact.normal = normal;
    contact.normal_force = force;
    contact.shear_force = 0.5 * force;
    state.contacts.push_back(contact);
  };
  for (int row = 0; row < n; ++row) {
    for (int column = 0; column < n; ++column) {
      const double x = 0.25 * (column - 40);
      if (row + 1 < n) add(index(column, row), index(column, row + 1), Vec2(0, 1), 0.25 * 3 * (1 + x / 10));
      if (column + 1 < n) add(index(column, row), index(column + 1, row), Vec2(1, 0), 0.5 * 2);
    }
  }
  const double area = 3.14159265358979323846 * 10 * 20;
  const auto stress = dem::interior_stress(state, area);
  // Chords of the lattice lines within the ellipse of semi-axes 7 and 14, times their forces. Two lines just touch the
  // ellipse: their chords are 0 or the square root of a rounding error.
  double xx = 0, yy = 0;
  for (int k = -40; k <= 40; ++k) {
    const double x = 0.25 * k / 7;
    const double y = 0.5 * k / 14;
    if (std::abs(y) < 1) xx += 0.5 * 2 * 14 * std::sqrt(1 - y * y);
    if (std::abs(x) < 1) yy += 0.25 * 3 * (1 + 0.7 * x) * 28 * std::sqrt(1 - x * x);
  }
  CHECK(stress[0] == Approx(xx / (0.49 * area)).epsilon(1e-9));
  CHECK(stress[1] == Approx(yy / (0.49 * area)).epsilon(1e-9));
  CHECK(stress[0] == Approx(2).epsilon(5e-3));
  CHECK(stress[1] == Approx(3).epsilon(5e-3));
  // Along +y over branches along x, along -x over branches along y: half of the forces, and the mean of both.
  CHECK(stress[2] == Approx(0.5 * (0.5 * stress[0] - 0.5 * stress[1])).epsilon(1e-12));
}
