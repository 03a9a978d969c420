#include "xfem/lab/first_failure.hpp"

#include <fmt/format.h>

#include "common/error.hpp"

namespace xfem {

namespace {

constexpr double kTie = 1e-9;
constexpr double kLargestFactor = 1e12;

Stress sum(const Stress& held, double factor, const Stress& growing) {
  return {held.xx + factor * growing.xx, held.yy + factor * growing.yy, held.xy + factor * growing.xy};
}

bool fails(const HoekBrown& rock, const Stress& stress) {
  const PrincipalStress p = principal(stress);
  return rock.load_factor(p.s1, p.s3) < 1;
}

}  // namespace

double failure_factor(const HoekBrown& rock, const Stress& held, const Stress& growing) {
  const PrincipalStress p = principal(growing);
  if (held.xx == 0 && held.yy == 0 && held.xy == 0) return rock.load_factor(p.s1, p.s3);
  if (fails(rock, held))
    throw common::bad_input(fmt::format(
        "loading: the held stress ({:.4g}, {:.4g}, {:.4g}) Pa fails before the load grows, expected one that holds",
        held.xx, held.yy, held.xy));
  double low = 0, high = 1;
  while (!fails(rock, sum(held, high, growing))) {
    low = high;
    high *= 2;
    if (high > kLargestFactor) return std::numeric_limits<double>::infinity();
  }
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return high;
    (fails(rock, sum(held, middle, growing)) ? high : low) = middle;
  }
}

FirstFailure first_failure(const HoekBrown& rock, std::span<const Stress> held, std::span<const Stress> growing,
                           std::span<const Vec2> centers) {
  std::vector<double> factors(growing.size());
  FirstFailure first;
  for (std::size_t e = 0; e < growing.size(); ++e) {
    factors[e] = failure_factor(rock, held.empty() ? Stress{} : held[e], growing[e]);
    first.factor = std::min(first.factor, factors[e]);
  }
  for (std::size_t e = 0; e < growing.size(); ++e) {
    if (!(factors[e] <= first.factor * (1 + kTie)) || factors[e] > kLargestFactor) continue;
    if (first.element < 0 || centers[e].squaredNorm() < centers[first.element].squaredNorm())
      first.element = static_cast<int>(e);
  }
  return first;
}

std::vector<Stress> superposed(std::span<const Stress> held, double factor, std::span<const Stress> growing) {
  std::vector<Stress> stresses;
  for (std::size_t e = 0; e < growing.size(); ++e)
    stresses.push_back(sum(held.empty() ? Stress{} : held[e], factor, growing[e]));
  return stresses;
}

}  // namespace xfem
