#include "xfem/particle_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "common/geometry/chord_split.hpp"

namespace xfem {
namespace {

/// Unbalanced part of a particle's forces above which it is worth a warning.
constexpr double kUnbalanceWarning = 0.05;
/// Part of the mean sum of contact forces below which a particle is not worth one.
constexpr double kHardlyLoaded = 0.05;

}  // namespace

std::vector<ParticleCase> gather_loads(const common::Frame& frame, const std::vector<common::Rotation>& rotation) {
  const common::Particles& particles = frame.particles;
  std::vector<ParticleCase> cases(particles.size());
  const auto add = [&](std::int64_t id, const Vec2& point, const Vec2& force) {
    const auto found = std::lower_bound(particles.id.begin(), particles.id.end(), id);
    if (found == particles.id.end() || *found != id)
      throw common::bad_input(
          fmt::format("frame {}: a contact names particle {}, which is not there", frame.frame, id));
    const std::size_t i = static_cast<std::size_t>(found - particles.id.begin());
    if (force.x() == 0 && force.y() == 0) return;
    if (!force.allFinite() || !point.allFinite()) {
      cases[i].failure = "a contact force or its point is not finite";
      return;
    }
    cases[i].loads.push_back({rotation[i].inverse(point - particles.position[i]), rotation[i].inverse(force)});
  };
  for (std::size_t c = 0; c < frame.contacts.size(); ++c) {
    add(frame.contacts.a[c], frame.contacts.point[c], -frame.contacts.force[c]);
    add(frame.contacts.b[c], frame.contacts.point[c], frame.contacts.force[c]);
  }
  return cases;
}

std::vector<Load> canonical_loads(const ParticleCase& particle) {
  std::vector<Load> loads;
  loads.reserve(particle.loads.size());
  for (const Load& load : particle.loads)
    loads.push_back({particle.shape.to_canonical(load.point), load.force / particle.shape.size});
  return loads;
}

BreakageResult to_metres(BreakageResult result, const CanonicalOutline& shape, PolygonView outline) {
  for (Crack& crack : result.cracks)
    for (CrackPoint& point : crack.points) point.position = shape.from_canonical(point.position);
  if (result.status == common::ParticleStatus::broken && result.path) {
    for (Vec2& end : *result.path) end = shape.from_canonical(end);
    common::ChordSplit pieces = common::split_by_chord(outline, (*result.path)[0], (*result.path)[1]);
    result.left = std::move(pieces.left);
    result.right = std::move(pieces.right);
  }
  return result;
}

bool is_finite(const Stress& s) {
  return std::isfinite(s.xx + s.yy + s.xy);
}

std::string defect_of(const BreakageResult& result) {
  if (!is_finite(result.mean_stress)) return "the stress is not finite";
  if (result.status != common::ParticleStatus::broken) return {};
  if (!result.path) return "broken without a path";
  for (const Polygon* fragment : {&result.left, &result.right})
    if (const std::string defect = common::outline_defect(*fragment); !defect.empty()) return "a fragment: " + defect;
  return {};
}

std::string unbalance_warning(const common::Frame& frame, const std::vector<ParticleCase>& cases) {
  // A particle that hardly carries anything may be far out of balance without meaning anything.
  std::vector<double> carried(cases.size(), 0.0);
  double sum = 0;
  int analysed = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].entry) continue;
    for (const Load& load : cases[i].loads) carried[i] += load.force.norm();
    sum += carried[i];
    ++analysed;
  }
  int count = 0;
  std::size_t worst = 0;
  double largest = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].entry || carried[i] < kHardlyLoaded * sum / analysed) continue;
    const double unbalance = IntactModel::unbalance(cases[i].loads);
    if (unbalance > kUnbalanceWarning) ++count;
    if (unbalance > largest) {
      largest = unbalance;
      worst = i;
    }
  }
  if (count == 0) return {};
  return fmt::format(
      "frame {}: the contact forces of {} of {} analysed particles are out of balance by more than {:.0f} % (worst: "
      "particle {}, {:.1f} %); the rest is taken as a body force",
      frame.frame, count, analysed, 100 * kUnbalanceWarning, frame.particles.id[worst], 100 * largest);
}

}  // namespace xfem
