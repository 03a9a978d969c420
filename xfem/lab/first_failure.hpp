// The load at which an uncracked specimen first fails when part of its load is held and the rest grows.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "xfem/criterion/hoek_brown.hpp"

namespace xfem {

struct FirstFailure {
  double factor = std::numeric_limits<double>::infinity();  ///< smallest over the elements; +inf: none ever fails
  int element = -1;                                         ///< of them; of a tie the one nearest to the origin
};

/// Smallest factor > 0 at which held + factor * growing reaches the Hoek-Brown envelope. Without held stress it is the
/// criterion's load factor in closed form. Else it is the root of the criterion along the path, to the last bit: the
/// stresses that do not fail form a convex set, so that it is left once and bisection cannot miss it.
/// Throws bad_input if the held stress fails by itself.
double failure_factor(const HoekBrown& rock, const Stress& held, const Stress& growing);

/// Over all elements; `held` may be empty. In a uniform field all fail at once: of those within 1e-9 of the smallest
/// factor the one whose `centers` entry is nearest to the origin is named, so that rounding does not settle the tie.
FirstFailure first_failure(const HoekBrown& rock, std::span<const Stress> held, std::span<const Stress> growing,
                           std::span<const Vec2> centers);

/// held + factor * growing, element by element; `held` may be empty.
std::vector<Stress> superposed(std::span<const Stress> held, double factor, std::span<const Stress> growing);

}  // namespace xfem
