#include "xfem/split_record.hpp"

#include <algorithm>
#include <limits>

#include "common/error.hpp"
#include "xfem/crack_state.hpp"

namespace xfem {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// World tensor of a body-frame tensor: R S R^T.
std::array<double, 3> to_world(const Stress& s, const common::Rotation& rotation) {
  const double c = rotation.cos, n = rotation.sin;
  return {c * c * s.xx + n * n * s.yy - 2 * c * n * s.xy, n * n * s.xx + c * c * s.yy + 2 * c * n * s.xy,
          c * n * (s.xx - s.yy) + (c * c - n * n) * s.xy};
}

void record_fragments(const common::Frame& frame, std::size_t i, const ParticleCase& particle, std::int64_t& next_id,
                      CrackState& handed_down, common::Split& split, const common::BreakageOptions& options) {
  const BreakageResult& result = particle.result;
  const std::array<Vec2, 2>& path = *result.path;
  split.broken.parent.push_back(frame.particles.id[i]);
  split.broken.path.push_back(path);
  const double clearance = particle.shape.size * particle.entry->model->particle.elastic.mesh().size;
  for (int side : {+1, -1}) {
    const Polygon& outline = side > 0 ? result.left : result.right;
    const std::int64_t id = next_id++;
    split.fragments.id.push_back(id);
    split.fragments.parent.push_back(frame.particles.id[i]);
    split.fragments.vertices.insert(split.fragments.vertices.end(), outline.begin(), outline.end());
    split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));

    const Vec2 origin = common::centroid(outline);
    const std::vector<InheritedCrack> inherited =
        inherited_cracks(result.cracks, result.path_cracks, path, side, origin, clearance);
    if (inherited.empty()) continue;
    Polygon own = outline;
    for (Vec2& vertex : own) vertex -= origin;
    // A fragment below the smallest size is never analysed, and one that cannot be meshed will be refused.
    if (common::area(own) < 2 * options.minimum_area) continue;
    try {
      const CanonicalOutline shape = canonical(own);
      const Mesh mesh = make_mesh(shape, options.nodes);
      for (InheritedCrack crack : inherited) {
        for (Vec2& point : crack.polyline) point = shape.to_canonical(point);
        Crack placed = place_polyline(mesh, crack.polyline, crack.tips);
        for (CrackPoint& point : placed.points) point.position = shape.from_canonical(point.position);
        if (placed.points.size() >= 2) handed_down[id].push_back(std::move(placed));
      }
    } catch (const common::Error&) {
      handed_down.erase(id);
    }
  }
}

}  // namespace

void record(const common::Frame& frame, const std::vector<common::Rotation>& rotation,
            const common::BreakageOptions& options, std::vector<ParticleCase>& cases, common::Split& split) {
  const common::Particles& particles = frame.particles;
  std::int64_t next_id = frame.next_id;
  if (!particles.id.empty()) next_id = std::max(next_id, particles.id.back() + 1);
  CrackState handed_down;

  for (std::size_t i = 0; i < cases.size(); ++i) {
    ParticleCase& particle = cases[i];
    BreakageResult& result = particle.result;
    const bool screened = result.status == common::ParticleStatus::screened;
    if (!particle.breakable) {
      result.status = common::ParticleStatus::not_breakable;
      result.min_safety_factor = kNotANumber;
    } else if (!particle.failure.empty()) {
      result = {};
      result.status = common::ParticleStatus::refused;
      result.reason = particle.failure;
      result.min_safety_factor = kNotANumber;
    } else if (particle.loads.empty()) {
      result.status = particle.stored ? common::ParticleStatus::arrested : common::ParticleStatus::intact;
      result.min_safety_factor = kInfinity;
    }
    const bool refused = result.status == common::ParticleStatus::refused;
    if (!particle.breakable || refused) {
      result.mean_stress = virial_stress(particle.loads, particles.outline(i));
      if (!is_finite(result.mean_stress)) result.mean_stress = {};  // of forces that overflow
    }
    // What was not analysed to its end keeps the cracks that it had.
    if ((!particle.solved || refused) && particle.stored) result.cracks = *particle.stored;
    if (refused) {
      split.refusals.particle.push_back(particles.id[i]);
      split.refusals.reason.push_back(result.reason);
    }
    if (particle.solved) ++split.work.solved;
    if (screened) ++split.work.screened;
    split.work.growth_steps += result.growth_steps;

    split.particles.id.push_back(particles.id[i]);
    split.particles.status.push_back(result.status);
    split.particles.mean_stress.push_back(to_world(result.mean_stress, rotation[i]));
    split.particles.min_safety_factor.push_back(result.min_safety_factor);
    const bool failed =
        result.status == common::ParticleStatus::arrested || result.status == common::ParticleStatus::broken;
    split.particles.failure_mode.push_back(failed ? result.failure_mode : FailureMode::none);
    if (result.status == common::ParticleStatus::broken)
      record_fragments(frame, i, particle, next_id, handed_down, split, options);
    else
      append_cracks(split, particles.id[i], result.cracks);
  }
  for (const auto& [id, cracks] : handed_down) append_cracks(split, id, cracks);
}

}  // namespace xfem
