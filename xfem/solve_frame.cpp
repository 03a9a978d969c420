#include "xfem/solve_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "common/error.hpp"
#include "xfem/crack_state.hpp"
#include "xfem/parallel.hpp"
#include "xfem/split_record.hpp"

namespace xfem {

namespace {

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

  void prepare(const common::Frame& frame, const CrackState& state, std::vector<ParticleCase>& cases);
  void screen_all(std::vector<ParticleCase>& cases) const;
  void analyse_all(const common::Frame& frame, std::vector<ParticleCase>& cases) const;
};

/// Decides who is analysed, and with which model.
void FrameSolver::Implementation::prepare(const common::Frame& frame, const CrackState& state,
                                          std::vector<ParticleCase>& cases) {
  const common::Particles& particles = frame.particles;
  cache->start_round();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    ParticleCase& particle = cases[i];
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
void FrameSolver::Implementation::screen_all(std::vector<ParticleCase>& cases) const {
  for_each_guarded(
      cases.size(), threads, [&](std::size_t i) -> std::string& { return cases[i].failure; },
      [&](std::size_t i) {
        ParticleCase& particle = cases[i];
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

void FrameSolver::Implementation::analyse_all(const common::Frame& frame, std::vector<ParticleCase>& cases) const {
  for_each_guarded(
      cases.size(), threads, [&](std::size_t i) -> std::string& { return cases[i].failure; },
      [&](std::size_t i) {
        ParticleCase& particle = cases[i];
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
  std::vector<ParticleCase> cases;
  // Room for the ids of all fragments that there can be.
  const std::int64_t largest = std::max(frame.next_id, frame.particles.id.empty() ? 0 : frame.particles.id.back());
  if (largest >= common::kLargestCount - 2 * std::ssize(frame.particles.id))
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
    record(frame, rotation, self.options, cases, split);
    if (std::string warning = unbalance_warning(frame, cases); !warning.empty())
      self.warnings.push_back(std::move(warning));
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
