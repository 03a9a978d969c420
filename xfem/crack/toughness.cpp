#include "xfem/crack/toughness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace xfem {

bool torn(const HoekBrown& rock, const Stress& stress) {
  return principal(stress).s3 < -0.5 * rock.tensile_strength();
}

TipDrive largest_hoop_stress(const StressIntensity& intensity) {
  const double one = std::max(0.0, intensity.one);
  const double two = intensity.two;
  const double sum = one + std::sqrt(one * one + 8 * two * two);
  const double tangent = sum > 0 ? -2 * two / sum : 0;
  const double c = 1 / std::sqrt(1 + tangent * tangent);
  const double s = tangent * c;
  const Vec2& axis = intensity.axis;
  return {c * c * (one * c - 3 * two * s), (c * c - s * s) * axis + 2 * s * c * common::perpendicular(axis)};
}

std::optional<TipDrive> tip_drive(const IntactModel& model, const GrowthRules& rules, const CrackedState& state,
                                  std::span<const Crack> cracks, int crack, int end) {
  const Crack& own = cracks[crack];
  double length = 0;
  for (std::size_t i = 1; i < own.points.size(); ++i) {
    length += (own.points[i].position - own.points[i - 1].position).norm();
  }
  const bool has_mouth = own.tips[1 - end] == TipState::at_boundary || own.tips[1 - end] == TipState::at_crack;
  const double reach = has_mouth ? length : length / 2;
  const double ratio = rules.toughness / rules.rock.tensile_strength();
  if (reach < ratio * ratio / std::numbers::pi) return std::nullopt;
  const CrackPoint& tip = end == 1 ? own.points.back() : own.points.front();
  if (reach < kResolvedLength * element_size(model.mesh(), tip)) return std::nullopt;
  const int next = element_ahead(model.mesh(), own, end);
  if (next < 0 || (fails_at_once(rules, next) && !torn(rules.rock, rules.uncracked[next]))) return std::nullopt;
  const std::optional<StressIntensity> intensity = stress_intensity(model, state, cracks, crack, end);
  if (!intensity) return std::nullopt;
  return largest_hoop_stress(*intensity);
}

}  // namespace xfem
