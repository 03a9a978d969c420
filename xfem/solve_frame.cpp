#include "xfem/solve_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "common/error.hpp"
#include "common/geometry/chord_split.hpp"
#include "xfem/crack_state.hpp"
#include "xfem/model_cache.hpp"
#include "xfem/parallel.hpp"

namespace xfem {

namespace {

/// Unbalanced part of a particle's forces above which it is worth a warning.
constexpr double kUnbalanceWarning = 0.05;
/// Part of the mean sum of contact forces below which a particle is not worth one.
constexpr double kHardlyLoaded = 0.05;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// What one particle brings to the analysis and takes from it.
struct Case {
  std::vector<Load> loads;  ///< body frame
  bool breakable = false;
  const std::vector<Crack>* stored = nullptr;  ///< cracks of the previous split
  CanonicalOutline shape;                      ///< of a breakable particle
  ModelCache::Entry* entry = nullptr;          ///< null: not analysed
  std::string failure;                         ///< why there is no model or no result
  bool solved = false;
  BreakageResult result;  ///< in metres
};

/// Adds the time since it was made to a phase.
class PhaseTimer {
 public:
  PhaseTimer(PhaseSeconds& seconds, const char* phase) : seconds_(seconds), phase_(phase) {}
  ~PhaseTimer() {
    seconds_[phase_] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  PhaseSeconds& seconds_;
  const char* phase_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// World tensor of a body-frame tensor: R S R^T.
std::array<double, 3> to_world(const Stress& s, const common::Rotation& rotation) {
  const double c = rotation.cos, n = rotation.sin;
  return {c * c * s.xx + n * n * s.yy - 2 * c * n * s.xy, n * n * s.xx + c * c * s.yy + 2 * c * n * s.xy,
          c * n * (s.xx - s.yy) + (c * c - n * n) * s.xy};
}

bool is_finite(const Stress& s) {
  return std::isfinite(s.xx + s.yy + s.xy);
}

/// Why a result cannot be written down; empty if it can.
std::string defect_of(const BreakageResult& result) {
  if (!is_finite(result.mean_stress)) return "the stress is not finite";
  if (result.status != common::ParticleStatus::broken) return {};
  if (!result.path) return "broken without a path";
  for (const Polygon* fragment : {&result.left, &result.right})
    if (const std::string defect = common::outline_defect(*fragment); !defect.empty()) return "a fragment: " + defect;
  return {};
}

std::vector<Load> canonical_loads(const Case& particle) {
  std::vector<Load> loads;
  loads.reserve(particle.loads.size());
  for (const Load& load : particle.loads)
    loads.push_back({particle.shape.to_canonical(load.point), load.force / particle.shape.size});
  return loads;
}

/// Takes a result in canonical coordinates back to metres. The fragments are cut anew from the true outline, so that
/// they share its vertices bit for bit.
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

std::vector<Case> gather_loads(const common::Frame& frame, const std::vector<common::Rotation>& rotation) {
  const common::Particles& particles = frame.particles;
  std::vector<Case> cases(particles.size());
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

}  // namespace

BreakageParameters breakage_parameters(const common::MaterialOptions& material, const common::BreakageOptions& options,
                                       const common::Effects& effects) {
  BreakageParameters parameters;
  if (effects.face_friction) parameters.face_friction = options.face_friction;
  if (effects.toughness) parameters.toughness = material.fracture_toughness;
  parameters.rock = {material.sigma_ci, material.m_i};
  parameters.initiation_radius = options.literal ? 0 : options.initiation_radius;
  parameters.minimum_fragment = options.minimum_fragment;
  parameters.minimum_area = options.minimum_area;
  parameters.max_cracks = options.max_cracks;
  parameters.literal = options.literal;
  return parameters;
}

ElasticConstants elastic_constants(const common::MaterialOptions& material) {
  return {material.young_modulus, material.poisson_ratio, material.plane_stress};
}

struct FrameSolver::Implementation {
  common::BreakageOptions options;
  BreakageParameters parameters;
  ElasticConstants constants;
  std::string config_hash;
  int threads;
  std::optional<ModelCache> cache;
  PhaseSeconds seconds;
  PhaseCounts counts;
  std::vector<std::string> warnings;

  void prepare(const common::Frame& frame, const CrackState& state, std::vector<Case>& cases);
  void screen_all(std::vector<Case>& cases) const;
  void analyse_all(const common::Frame& frame, std::vector<Case>& cases) const;
  void record(const common::Frame& frame, const std::vector<common::Rotation>& rotation, std::vector<Case>& cases,
              common::Split& split) const;
  void record_fragments(const common::Frame& frame, std::size_t i, const Case& particle, std::int64_t& next_id,
                        CrackState& handed_down, common::Split& split) const;
  void warn_of_unbalance(const common::Frame& frame, const std::vector<Case>& cases);
};

/// Decides who is analysed, and with which model.
void FrameSolver::Implementation::prepare(const common::Frame& frame, const CrackState& state,
                                          std::vector<Case>& cases) {
  const common::Particles& particles = frame.particles;
  cache->start_round();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Case& particle = cases[i];
    const PolygonView outline = particles.outline(i);
    const auto stored = state.find(particles.id[i]);
    if (stored != state.end()) particle.stored = &stored->second;
    particle.breakable = !particles.boundary[i] && !(common::area(outline) < 2 * options.minimum_area);
    if (!particle.breakable) continue;
    try {
      particle.shape = canonical(outline);
    } catch (const common::Error& error) {
      particle.failure = error.what();
      continue;
    }
    ModelCache::Entry& entry = cache->at(particle.shape.outline);
    if (particle.loads.empty() || !particle.failure.empty()) continue;
    particle.entry = &entry;
    if (!entry.model && entry.failure.empty()) entry.wanted = true;
  }
}

/// What has no cracks and cannot fail is done with here.
void FrameSolver::Implementation::screen_all(std::vector<Case>& cases) const {
  for_each_guarded(
      cases.size(), threads, [&](std::size_t i) -> std::string& { return cases[i].failure; },
      [&](std::size_t i) {
        Case& particle = cases[i];
        if (!particle.entry || !particle.entry->model || particle.stored) return;
        const std::optional<Influence>& influence = particle.entry->model->influence;
        if (!influence) return;
        const Influence::Bound bound = influence->bound(canonical_loads(particle), parameters.rock);
        if (!(bound.safety_factor > 1) || !is_finite(bound.mean_stress)) return;
        particle.result.status = common::ParticleStatus::screened;
        particle.result.min_safety_factor = bound.safety_factor;
        particle.result.mean_stress = bound.mean_stress;
      });
}

void FrameSolver::Implementation::analyse_all(const common::Frame& frame, std::vector<Case>& cases) const {
  for_each_guarded(
      cases.size(), threads, [&](std::size_t i) -> std::string& { return cases[i].failure; },
      [&](std::size_t i) {
        Case& particle = cases[i];
        if (!particle.entry || particle.result.status == common::ParticleStatus::screened) return;
        if (!particle.entry->model) {
          particle.failure = particle.entry->failure;
          return;
        }
        const ParticleModel& model = particle.entry->model->particle;
        std::vector<Crack> cracks;
        if (particle.stored)
          for (Crack stored : *particle.stored) {
            for (CrackPoint& point : stored.points) point.position = particle.shape.to_canonical(point.position);
            if (std::optional<Crack> crack = crack_on_mesh(model.elastic.mesh(), stored))
              cracks.push_back(std::move(*crack));
          }
        const BreakageResult result =
            analyse(model, canonical_loads(particle), cracks, in_units_of(particle.shape.size, parameters));
        particle.result = to_metres(result, particle.shape, frame.particles.outline(i));
        particle.failure = defect_of(particle.result);
        particle.solved = particle.failure.empty();
      });
}

void FrameSolver::Implementation::record_fragments(const common::Frame& frame, std::size_t i, const Case& particle,
                                                   std::int64_t& next_id, CrackState& handed_down,
                                                   common::Split& split) const {
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

void FrameSolver::Implementation::record(const common::Frame& frame, const std::vector<common::Rotation>& rotation,
                                         std::vector<Case>& cases, common::Split& split) const {
  const common::Particles& particles = frame.particles;
  std::int64_t next_id = frame.next_id;
  if (!particles.id.empty()) next_id = std::max(next_id, particles.id.back() + 1);
  CrackState handed_down;

  for (std::size_t i = 0; i < cases.size(); ++i) {
    Case& particle = cases[i];
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
      record_fragments(frame, i, particle, next_id, handed_down, split);
    else
      append_cracks(split, particles.id[i], result.cracks);
  }
  for (const auto& [id, cracks] : handed_down) append_cracks(split, id, cracks);
}

void FrameSolver::Implementation::warn_of_unbalance(const common::Frame& frame, const std::vector<Case>& cases) {
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
  if (count > 0)
    warnings.push_back(fmt::format(
        "frame {}: the contact forces of {} of {} analysed particles are out of balance by more than {:.0f} % (worst: "
        "particle {}, {:.1f} %); the rest is taken as a body force",
        frame.frame, count, analysed, 100 * kUnbalanceWarning, frame.particles.id[worst], 100 * largest));
}

FrameSolver::FrameSolver(const common::Scene& scene, int threads)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->options = scene.breakage;
  implementation_->parameters = breakage_parameters(scene.material, scene.breakage, scene.effects);
  implementation_->constants = elastic_constants(scene.material);
  implementation_->cache.emplace(scene.breakage.nodes, implementation_->constants,
                                 implementation_->parameters.initiation_radius);
  implementation_->config_hash = common::config_hash(scene, common::UsedBy::xfem);
  implementation_->threads = threads > 0 ? threads : available_processors();
}

FrameSolver::~FrameSolver() = default;

common::Split FrameSolver::solve(const common::Frame& frame, const common::Split* previous) {
  Implementation& self = *implementation_;
  self.seconds.clear();
  self.counts.clear();
  self.warnings.clear();

  CrackState state;
  std::vector<common::Rotation> rotation;
  std::vector<Case> cases;
  // Room for the ids of all fragments that there can be.
  const std::int64_t largest = std::max(frame.next_id, frame.particles.id.empty() ? 0 : frame.particles.id.back());
  if (largest >= std::numeric_limits<std::int64_t>::max() - 2 * std::ssize(frame.particles.id))
    throw common::bad_input(fmt::format("frame {}: ids up to {} leave none for fragments", frame.frame, largest));
  {
    const PhaseTimer timer(self.seconds, "loads");
    if (previous) {
      check_previous(*previous, frame, self.config_hash);
      state = stored_cracks(*previous);
    }
    for (double angle : frame.particles.angle) rotation.emplace_back(angle);
    cases = gather_loads(frame, rotation);
    self.prepare(frame, state, cases);
  }
  {
    const PhaseTimer timer(self.seconds, "models");
    self.counts["models_built"] = self.cache->build(self.threads);
  }
  {
    const PhaseTimer timer(self.seconds, "screening");
    self.screen_all(cases);
  }
  {
    const PhaseTimer timer(self.seconds, "analysis");
    self.analyse_all(frame, cases);
  }

  common::Split split;
  split.frame = frame.frame;
  split.frame_hash = frame.payload_hash;
  split.config_hash = self.config_hash;
  {
    const PhaseTimer timer(self.seconds, "record");
    self.record(frame, rotation, cases, split);
    self.warn_of_unbalance(frame, cases);
  }
  self.counts["particles"] = static_cast<std::int64_t>(frame.particles.size());
  self.counts["contacts"] = static_cast<std::int64_t>(frame.contacts.size());
  self.counts["screened"] = split.work.screened;
  self.counts["solved"] = split.work.solved;
  self.counts["growth_steps"] = split.work.growth_steps;
  self.counts["broken"] = static_cast<std::int64_t>(split.broken.parent.size());
  self.counts["refused"] = static_cast<std::int64_t>(split.refusals.particle.size());
  return split;
}

const PhaseSeconds& FrameSolver::seconds() const {
  return implementation_->seconds;
}
const PhaseCounts& FrameSolver::counts() const {
  return implementation_->counts;
}
const std::vector<std::string>& FrameSolver::warnings() const {
  return implementation_->warnings;
}

}  // namespace xfem
