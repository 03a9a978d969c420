#include "xfem/criterion/hoek_brown.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace xfem {

PrincipalStress principal(const Stress& stress) {
  const double mean = 0.5 * (stress.xx + stress.yy);
  const double half = 0.5 * (stress.xx - stress.yy);
  const double radius = std::sqrt(half * half + stress.xy * stress.xy);
  PrincipalStress result{mean + radius, mean - radius, {1, 0}};
  if (radius == 0) return result;
  // cos 2a = half / radius, sin 2a = xy / radius. The larger of cos a, sin a comes from the half-angle formula, the
  // other by division, so that neither cancels.
  if (half >= 0) {
    const double c = std::sqrt(0.5 * (1 + half / radius));
    result.direction1 = {c, 0.5 * stress.xy / (radius * c)};
  } else {
    const double s = std::sqrt(0.5 * (1 - half / radius));
    result.direction1 = {0.5 * std::abs(stress.xy) / (radius * s), stress.xy < 0 ? -s : s};
  }
  return result;
}

double HoekBrown::strength(double s3) const {
  return s3 + sigma_ci * std::sqrt(std::max(0.0, m_i * s3 / sigma_ci + 1));
}

double HoekBrown::load_factor(double s1, double s3) const {
  // lambda d = sigma_ci sqrt(m lambda s3 / sigma_ci + 1) squared is e^2 lambda^2 - a lambda - 1 = 0; its positive root
  // in the form that does not cancel, with a and e scaled so that neither square under- or overflows.
  const double a = m_i * s3 / sigma_ci;
  const double e = std::max(0.0, s1 - s3) / sigma_ci;
  const double scale = std::max(std::abs(a), 2 * e);
  if (scale == 0) return std::numeric_limits<double>::infinity();
  const double a1 = a / scale;
  const double e1 = e / scale;
  const double root = std::sqrt(a1 * a1 + 4 * e1 * e1);
  if (a < 0) {
    // Never beyond the tensile cut-off -1 / a, which it reaches for e = 0.
    return std::min(2 / (root - a1) / scale, -1 / a);
  }
  return (a1 + root) / (2 * e1 * e1) / scale;
}

FailureMode HoekBrown::mode(double s1, double s3) const {
  if (s3 >= 0) return s1 > s3 ? FailureMode::shear : FailureMode::none;
  const double tangent_point = m_i + 1 - 2 * std::sqrt(m_i + 1);
  return m_i > 3 && s1 <= -tangent_point * s3 ? FailureMode::tension : FailureMode::shear;
}

HoekBrown::Planes HoekBrown::planes(const PrincipalStress& stress) const {
  const FailureMode kind = mode(stress.s1, stress.s3);
  const Vec2& d = stress.direction1;
  if (kind == FailureMode::tension) return {d, d, kind};
  // On the envelope sqrt(m lambda s3 / sigma_ci + 1) = r = lambda (s1 - s3) / sigma_ci, so the slope is
  // k = 1 + m / (2 r) and sin(phi) = (k - 1) / (k + 1) = m / (m + 4 r). With theta = pi/4 - phi/2:
  // cos(2 theta) = sin(phi), cos^2(theta) = (1 + sin phi) / 2, sin^2(theta) = (1 - sin phi) / 2.
  const double r = load_factor(stress.s1, stress.s3) * (std::max(0.0, stress.s1 - stress.s3) / sigma_ci);
  double c = std::sqrt(0.5);
  double s = c;
  if (std::isfinite(r)) {
    c = std::sqrt((m_i + 2 * r) / (m_i + 4 * r));
    s = std::sqrt(2 * r / (m_i + 4 * r));
  }
  const Vec2 n = common::perpendicular(d);
  return {c * d + s * n, c * d - s * n, kind};
}

}  // namespace xfem
