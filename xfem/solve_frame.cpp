#include "xfem/solve_frame.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>

#include "common/error.hpp"
#include "xfem/crack_state.hpp"

namespace xfem {

namespace {

/// Unbalanced part of a particle's forces above which it is worth a warning.
constexpr double kUnbalanceWarning = 0.05;
/// Part of the mean sum of contact forces below which a particle is not worth one.
constexpr double kHardlyLoaded = 0.05;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

using ModelCache = std::map<std::int64_t, std::unique_ptr<ParticleModel>>;

/// What one particle brings to the analysis and takes from it.
struct Case {
  std::vector<Load> loads;  ///< body frame
  bool breakable = false;
  const std::vector<Crack>* stored = nullptr;      ///< cracks of the previous split
  std::unique_ptr<ParticleModel>* slot = nullptr;  ///< in the cache; null: not analysed
  std::string failure;                             ///< why there is no model or no result
  BreakageResult result;
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

bool same_bits(PolygonView a, PolygonView b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

/// World tensor of a body-frame tensor: R S R^T.
std::array<double, 3> to_world(const Stress& s, const common::Rotation& rotation) {
  const double c = rotation.cos, n = rotation.sin;
  return {c * c * s.xx + n * n * s.yy - 2 * c * n * s.xy, n * n * s.xx + c * c * s.yy + 2 * c * n * s.xy,
          c * n * (s.xx - s.yy) + (c * c - n * n) * s.xy};
}

/// Why a result cannot be written down; empty if it can.
std::string defect_of(const BreakageResult& result) {
  if (!std::isfinite(result.mean_stress.xx + result.mean_stress.yy + result.mean_stress.xy))
    return "the stress is not finite";
  if (result.status != common::ParticleStatus::broken) return {};
  if (!result.path) return "broken without a path";
  for (const Polygon* fragment : {&result.left, &result.right})
    if (const std::string defect = common::outline_defect(*fragment); !defect.empty()) return "a fragment: " + defect;
  return {};
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
    cases[i].loads.push_back({rotation[i].inverse(point - particles.position[i]), rotation[i].inverse(force)});
  };
  for (std::size_t c = 0; c < frame.contacts.size(); ++c) {
    add(frame.contacts.a[c], frame.contacts.point[c], -frame.contacts.force[c]);
    add(frame.contacts.b[c], frame.contacts.point[c], frame.contacts.force[c]);
  }
  return cases;
}

}  // namespace

BreakageParameters breakage_parameters(const common::MaterialOptions& material,
                                       const common::BreakageOptions& options) {
  BreakageParameters parameters;
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
  ModelCache cache;
  PhaseSeconds seconds;
  PhaseCounts counts;
  std::vector<std::string> warnings;

  void prepare(const common::Frame& frame, const CrackState& state, std::vector<Case>& cases);
  void build_models(const common::Frame& frame, std::vector<Case>& cases);
  void analyse_all(std::vector<Case>& cases);
  void record(const common::Frame& frame, const std::vector<common::Rotation>& rotation, std::vector<Case>& cases,
              common::Split& split) const;
  void record_fragments(const common::Frame& frame, std::size_t i, const Case& particle, std::int64_t& next_id,
                        CrackState& handed_down, common::Split& split) const;
  void warn_of_unbalance(const common::Frame& frame, const std::vector<Case>& cases);
};

/// Decides who is analysed, and keeps of the cache what still fits.
void FrameSolver::Implementation::prepare(const common::Frame& frame, const CrackState& state,
                                          std::vector<Case>& cases) {
  const common::Particles& particles = frame.particles;
  ModelCache kept;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Case& particle = cases[i];
    const PolygonView outline = particles.outline(i);
    const auto stored = state.find(particles.id[i]);
    if (stored != state.end()) particle.stored = &stored->second;
    particle.breakable = !particles.boundary[i] && !(common::area(outline) < 2 * options.minimum_area);
    const auto cached = cache.find(particles.id[i]);
    const bool fits = cached != cache.end() && cached->second && same_bits(cached->second->outline, outline);
    const bool analysed = particle.breakable && !particle.loads.empty();
    if (!fits && !analysed) continue;
    std::unique_ptr<ParticleModel>& slot = kept[particles.id[i]];
    if (fits) slot = std::move(cached->second);
    if (analysed) particle.slot = &slot;
  }
  cache = std::move(kept);
}

void FrameSolver::Implementation::build_models(const common::Frame& frame, std::vector<Case>& cases) {
  const PhaseTimer timer(seconds, "models");
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (cases[i].slot && !*cases[i].slot) missing.push_back(i);
  std::exception_ptr fatal;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t k = 0; k < missing.size(); ++k) {
    Case& particle = cases[missing[k]];
    try {
      *particle.slot = std::make_unique<ParticleModel>(frame.particles.outline(missing[k]), options.nodes, constants,
                                                       parameters.initiation_radius);
    } catch (const common::Error& error) {
      particle.failure = error.what();
    } catch (...) {
#pragma omp critical
      fatal = std::current_exception();
    }
  }
  if (fatal) std::rethrow_exception(fatal);
  counts["models_built"] = static_cast<std::int64_t>(missing.size());
}

void FrameSolver::Implementation::analyse_all(std::vector<Case>& cases) {
  const PhaseTimer timer(seconds, "analysis");
  std::exception_ptr fatal;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Case& particle = cases[i];
    if (!particle.slot || !*particle.slot) continue;
    const ParticleModel& model = **particle.slot;
    try {
      std::vector<Crack> cracks;
      if (particle.stored)
        for (const Crack& stored : *particle.stored)
          if (std::optional<Crack> crack = crack_on_mesh(model.elastic.mesh(), stored))
            cracks.push_back(std::move(*crack));
      particle.result = analyse(model, particle.loads, cracks, parameters);
      particle.failure = defect_of(particle.result);
    } catch (const common::Error& error) {
      particle.failure = error.what();
    } catch (...) {
#pragma omp critical
      fatal = std::current_exception();
    }
  }
  if (fatal) std::rethrow_exception(fatal);
}

void FrameSolver::Implementation::record_fragments(const common::Frame& frame, std::size_t i, const Case& particle,
                                                   std::int64_t& next_id, CrackState& handed_down,
                                                   common::Split& split) const {
  const BreakageResult& result = particle.result;
  const std::array<Vec2, 2>& path = *result.path;
  split.broken.parent.push_back(frame.particles.id[i]);
  split.broken.path.push_back(path);
  const double clearance = (*particle.slot)->elastic.mesh().size;
  for (int side : {+1, -1}) {
    const Polygon& outline = side > 0 ? result.left : result.right;
    const std::int64_t id = next_id++;
    split.fragments.id.push_back(id);
    split.fragments.parent.push_back(frame.particles.id[i]);
    split.fragments.vertices.insert(split.fragments.vertices.end(), outline.begin(), outline.end());
    split.fragments.vertex_offset.push_back(static_cast<std::int64_t>(split.fragments.vertices.size()));

    const Vec2 origin = common::centroid(outline);
    const std::vector<InheritedCrack> inherited = inherited_cracks(result.cracks, path, side, origin, clearance);
    if (inherited.empty()) continue;
    Polygon own = outline;
    for (Vec2& vertex : own) vertex -= origin;
    // A fragment below the smallest size is never analysed, and one that cannot be meshed will be refused.
    if (common::area(own) < 2 * options.minimum_area) continue;
    try {
      const Mesh mesh = make_mesh(own, options.nodes);
      for (const InheritedCrack& crack : inherited) {
        Crack placed = place_polyline(mesh, crack.polyline, crack.tips);
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
    const bool solved = particle.slot && particle.failure.empty();
    if (!particle.breakable) {
      result.status = common::ParticleStatus::not_breakable;
      result.min_safety_factor = kNotANumber;
    } else if (particle.loads.empty()) {
      result.status = particle.stored ? common::ParticleStatus::arrested : common::ParticleStatus::intact;
      result.min_safety_factor = kInfinity;
    } else if (!solved) {
      result = {};
      result.status = common::ParticleStatus::refused;
      result.reason = particle.failure;
      result.min_safety_factor = kNotANumber;
    }
    const bool refused = result.status == common::ParticleStatus::refused;
    if (!particle.breakable || refused) result.mean_stress = virial_stress(particle.loads, particles.outline(i));
    // What was not analysed to its end keeps the cracks that it had.
    if ((!solved || refused) && particle.stored) result.cracks = *particle.stored;
    if (refused) {
      split.refusals.particle.push_back(particles.id[i]);
      split.refusals.reason.push_back(result.reason);
    }
    if (solved) ++split.work.solved;
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
    if (!cases[i].slot) continue;
    for (const Load& load : cases[i].loads) carried[i] += load.force.norm();
    sum += carried[i];
    ++analysed;
  }
  int count = 0;
  std::size_t worst = 0;
  double largest = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (!cases[i].slot || carried[i] < kHardlyLoaded * sum / analysed) continue;
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
  implementation_->parameters = breakage_parameters(scene.material, scene.breakage);
  implementation_->constants = elastic_constants(scene.material);
  implementation_->config_hash = common::config_hash(scene, common::UsedBy::xfem);
  implementation_->threads = threads > 0 ? threads : omp_get_num_procs();
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
  self.build_models(frame, cases);
  self.analyse_all(cases);

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
