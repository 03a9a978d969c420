#include "xfem/breakage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/error.hpp"
#include "common/geometry/chord_split.hpp"
#include "xfem/crack/cracked_solver.hpp"
#include "xfem/crack/growth.hpp"
#include "xfem/crack/toughness.hpp"

namespace xfem {
namespace {

using common::ParticleStatus;

/// The ligament rule's reach: the larger of these times De and h. At 1.2 h a crack of a coarse disc stops one element
/// short of it, in the compression below the load.
constexpr double kLigamentInDiameters = 0.1;
constexpr double kLigamentInElements = 1.5;
/// A new crack keeps this far from the others: the larger of the averaging radius and this times h. Within it the
/// averaged stress is that of an existing tip, whose own rule decides.
constexpr double kCrackSpacingInElements = 1.5;

/// Load factors nearer to each other than this are equal: the first element has it, whatever the rounding (symmetric
/// particles).
constexpr double kTie = 1e-9;

/// The mean stress of a solution is that of its loads (virial); one that misses it by more than this share of the loads
/// times diameter over area comes from a system too badly conditioned to say anything, that of a sliver of 100:1.
constexpr double kBalance = 1e-6;

struct Critical {
  int element = -1;
  double load_factor = std::numeric_limits<double>::infinity();
};

/// Pieces of the particle along a line, if both are large enough.
std::optional<common::ChordSplit> split_into_fragments(const ParticleModel& model, const BreakageParameters& parameters,
                                                       const Vec2& first, const Vec2& last) {
  common::ChordSplit pieces;
  try {
    pieces = common::split_by_chord(model.outline, first, last);
  } catch (const common::Error&) {
    return std::nullopt;  // both ends on one edge: nothing is cut off
  }
  const double smallest = std::max(parameters.minimum_fragment * model.area, parameters.minimum_area);
  if (std::min(common::area(pieces.left), common::area(pieces.right)) < smallest) return std::nullopt;
  return pieces;
}

/// The analysis of one particle under one set of loads.
class Analysis {
 public:
  Analysis(const ParticleModel& model, std::span<const Load> loads, std::span<const Crack> cracks,
           const BreakageParameters& parameters)
      : model_(model),
        mesh_(model.elastic.mesh()),
        parameters_(parameters),
        diameter_(common::equivalent_diameter(model.area)),
        rules_{parameters.rock,
               std::max(kLigamentInDiameters * diameter_, kLigamentInElements * mesh_.size),
               parameters.literal,
               {},
               parameters.literal ? 0 : parameters.toughness},
        solver_(model.elastic, loads, parameters.literal ? 0 : parameters.load_patch * diameter_,
                parameters.literal ? 0 : parameters.face_friction),
        stored_(cracks.begin(), cracks.end()),
        cracks_(stored_) {
    virial_ = virial_stress(loads, model.outline, parameters.literal ? 0 : parameters.load_patch * diameter_);
    for (const Load& load : loads) stress_scale_ += load.force.norm();
    stress_scale_ *= common::diameter(model.outline) / model.area;
    result_.unbalance = IntactModel::unbalance(loads);
  }

  BreakageResult run();
  double first_growth();

 private:
  std::vector<Stress> averaged(const std::vector<Stress>& stress) const {
    return parameters_.literal ? stress : model_.average(stress);
  }
  bool restore_cracks();
  bool solve();
  double imbalance(const Stress& mean) const;
  std::optional<DrivenTip> driven(int crack, int end) const;
  bool grow_tips();
  bool settle(const TipStep& step, int crack);
  bool breaks_or_chips(int crack, bool& breaks);
  bool start_next_crack();
  std::vector<int> component_of(int crack) const;
  void refuse(const std::string& reason);

  const ParticleModel& model_;
  const Mesh& mesh_;
  const BreakageParameters& parameters_;
  double diameter_;
  GrowthRules rules_;
  CrackedSolver solver_;
  const std::vector<Crack> stored_;
  std::vector<Crack> cracks_;
  Stress virial_;                  ///< mean stress that the loads ask for
  double stress_scale_ = 0;        ///< sum of the forces times diameter over area [Pa]
  std::vector<Stress> uncracked_;  ///< averaged stress of the uncracked particle
  CrackedState state_;
  std::set<int> no_start_;  ///< elements in which a crack would only cut off a corner
  BreakageResult result_;
  bool finished_ = false;
};

void Analysis::refuse(const std::string& reason) {
  result_.status = ParticleStatus::refused;
  result_.reason = reason;
  finished_ = true;
}

/// Checks the stored cracks. A crack that reaches the boundary at a second place without having split the particle
/// loses its last points there: the rest holds, and it does not grow there again.
bool Analysis::restore_cracks() {
  for (std::size_t c = 0; c < cracks_.size(); ++c) {
    const std::string defect = crack_defect(mesh_, cracks_[c]);
    if (!defect.empty()) {
      refuse("stored crack " + std::to_string(c) + " does not fit the mesh: " + defect);
      return false;
    }
    for (int end = 0; end < 2; ++end) {
      const CrackPoint& point = end == 0 ? cracks_[c].points.front() : cracks_[c].points.back();
      if (on_boundary(mesh_, point)) {
        cracks_[c].tips[end] = TipState::at_boundary;
      } else if (cracks_[c].tips[end] == TipState::at_boundary) {
        cracks_[c].tips[end] = TipState::active;
      }
    }
  }
  for (std::size_t c = 0; c < cracks_.size(); ++c) {
    for (int end = 0; end < 2; ++end) {
      if (cracks_[c].tips[end] != TipState::at_boundary) continue;
      int mouths = 0;
      for (const int member : component_of(static_cast<int>(c))) {
        for (const TipState tip : cracks_[member].tips) mouths += tip == TipState::at_boundary;
      }
      if (mouths < 2) continue;
      auto& points = cracks_[c].points;
      points.erase(end == 0 ? points.begin() : points.end() - 1);
      cracks_[c].tips[end] = TipState::arrested;
      if (points.size() < 2) break;
    }
  }
  std::erase_if(cracks_, [](const Crack& crack) { return crack.points.size() < 2; });
  // The crack that a tip once ran into may be gone: it was the parent's, of which this particle is a fragment.
  const std::vector<int> cutting = cutting_cracks(mesh_, cracks_);
  for (Crack& crack : cracks_) {
    for (int end = 0; end < 2; ++end) {
      if (crack.tips[end] != TipState::at_crack) continue;
      const int ahead = element_ahead(mesh_, crack, end);
      if (ahead >= 0 && cutting[ahead] < 0) crack.tips[end] = TipState::active;
    }
  }
  return true;
}

/// By how much a mean stress misses the virial, as a share of the loads times diameter over area.
double Analysis::imbalance(const Stress& mean) const {
  const double off =
      std::max({std::abs(mean.xx - virial_.xx), std::abs(mean.yy - virial_.yy), std::abs(mean.xy - virial_.xy)});
  return off > 0 ? off / stress_scale_ : 0;
}

bool Analysis::solve() {
  state_ = solver_.solve(cracks_);
  if (!state_.solved) refuse("the cracked system is singular: a part of the particle is loose (" + state_.defect + ")");
  if (!state_.settled) refuse("contact of the crack faces did not settle");
  return state_.solved && state_.settled;
}

/// All cracks that hang together with `crack` by tips that ran into one another, ascending.
std::vector<int> Analysis::component_of(int crack) const {
  const std::vector<int> cutting = cutting_cracks(mesh_, cracks_);
  const int n = static_cast<int>(cracks_.size());
  std::vector<int> label(n);
  for (int c = 0; c < n; ++c) label[c] = c;
  for (int c = 0; c < n; ++c) {
    if (cracks_[c].points.size() < 2) continue;
    for (int end = 0; end < 2; ++end) {
      if (cracks_[c].tips[end] != TipState::at_crack) continue;
      const int ahead = element_ahead(mesh_, cracks_[c], end);
      const int other = ahead < 0 ? -1 : cutting[ahead];
      if (other < 0 || label[other] == label[c]) continue;
      const int from = std::max(label[other], label[c]);
      const int to = std::min(label[other], label[c]);
      std::replace(label.begin(), label.end(), from, to);
    }
  }
  std::vector<int> members;
  for (int c = 0; c < n; ++c) {
    if (label[c] == label[crack]) members.push_back(c);
  }
  return members;
}

/// True if the cracks connected with `crack` join two boundary points; `breaks` tells whether the pieces are large
/// enough, and then they stand in the result.
bool Analysis::breaks_or_chips(int crack, bool& breaks) {
  std::vector<Vec2> mouths;
  std::vector<int> members = component_of(crack);
  for (const int member : members) {
    for (int end = 0; end < 2; ++end) {
      if (cracks_[member].tips[end] != TipState::at_boundary) continue;
      mouths.push_back((end == 0 ? cracks_[member].points.front() : cracks_[member].points.back()).position);
    }
  }
  breaks = false;
  if (mouths.size() < 2) return false;
  double largest_minor = 0;
  for (std::size_t i = 0; i < mouths.size(); ++i) {
    for (std::size_t j = i + 1; j < mouths.size(); ++j) {
      std::optional<common::ChordSplit> pieces = split_into_fragments(model_, parameters_, mouths[i], mouths[j]);
      if (!pieces) continue;
      const double minor = std::min(common::area(pieces->left), common::area(pieces->right));
      if (minor <= largest_minor) continue;
      largest_minor = minor;
      breaks = true;
      result_.path = {mouths[i], mouths[j]};
      result_.left = std::move(pieces->left);
      result_.right = std::move(pieces->right);
    }
  }
  if (breaks) result_.path_cracks = std::move(members);
  return true;
}

/// Takes over a tip's step; false if the analysis ends with it.
bool Analysis::settle(const TipStep& step, int crack) {
  cracks_[crack] = step.crack;
  if (step.outcome == TipOutcome::arrested) result_.reason = "no valid way on";
  if (step.outcome == TipOutcome::through || step.outcome == TipOutcome::merged) {
    bool breaks = false;
    if (breaks_or_chips(crack, breaks)) {
      if (breaks) {
        result_.status = ParticleStatus::broken;
        result_.reason.clear();
        finished_ = true;
        return false;
      }
      cracks_[crack] = step.fallback;
      result_.reason = "chip";
    }
  }
  return solve();
}

/// What toughness says of a tip now; empty if strength decides.
std::optional<DrivenTip> Analysis::driven(int crack, int end) const {
  if (rules_.toughness <= 0) return std::nullopt;
  const std::optional<TipDrive> drive = tip_drive(model_.elastic, rules_, state_, cracks_, crack, end);
  if (!drive) return std::nullopt;
  return DrivenTip{drive->equivalent >= rules_.toughness, drive->direction};
}

/// One step of every active tip, in order; true if something changed and the analysis goes on. With a declared
/// toughness a tip waits at the ligament until all others rest: where it breaks through, the forces near the mouth
/// part, and the stress intensity at the other end is that of two halves that turn.
bool Analysis::grow_tips() {
  bool changed = false;
  for (const bool waiting : {false, true}) {
    for (int c = 0; c < static_cast<int>(cracks_.size()); ++c) {
      for (int end = 0; end < 2; ++end) {
        if (cracks_[c].tips[end] != TipState::active) continue;
        const std::optional<DrivenTip> drive = driven(c, end);
        const bool waits = rules_.toughness > 0 && at_ligament(mesh_, model_.outline, rules_, cracks_[c], end);
        if (waits != waiting) continue;
        const TipStep step = advance_tip(mesh_, model_.outline, rules_, state_.stress, cutting_cracks(mesh_, cracks_),
                                         cracks_, c, end, drive);
        if (step.outcome == TipOutcome::stays) continue;
        ++result_.growth_steps;
        changed = true;
        if (!settle(step, c)) return false;
        if (result_.growth_steps > 4 * static_cast<int>(mesh_.triangles.size())) {
          refuse("crack growth did not come to an end");
          return false;
        }
      }
    }
    if (changed || rules_.toughness <= 0) break;
  }
  return changed;
}

/// Starts a crack where the averaged stress fails first, away from the cracks that are there; false if none starts.
bool Analysis::start_next_crack() {
  if (static_cast<int>(cracks_.size()) >= parameters_.max_cracks) return false;
  const std::vector<Stress> stress = averaged(state_.stress);
  const std::vector<int> cutting = cutting_cracks(mesh_, cracks_);
  const double spacing = std::max(parameters_.literal ? 0.0 : parameters_.initiation_radius * diameter_,
                                  kCrackSpacingInElements * mesh_.size);
  while (true) {
    Critical critical;
    for (int t = 0; t < static_cast<int>(stress.size()); ++t) {
      if (cutting[t] >= 0 || no_start_.contains(t)) continue;
      const double factor = load_factor(parameters_.rock, stress[t]);
      if (factor > 1 || !(factor < critical.load_factor * (1 - kTie))) continue;
      const Vec2 center = mesh_.centroid(t);
      const bool is_near = std::any_of(cracks_.begin(), cracks_.end(), [&](const Crack& crack) {
        return std::any_of(crack.points.begin(), crack.points.end(), [&](const CrackPoint& point) {
          return (point.position - center).squaredNorm() < spacing * spacing;
        });
      });
      if (!is_near) critical = {t, factor};
    }
    if (critical.element < 0) return false;
    const std::optional<Crack> crack = start_crack(mesh_, rules_, stress, critical.element);
    if (!crack) {
      no_start_.insert(critical.element);
      result_.reason = "chip";
      continue;
    }
    cracks_.push_back(*crack);
    return solve();
  }
}

BreakageResult Analysis::run() {
  const std::vector<Stress> intact = model_.elastic.stresses(solver_.intact_displacement());
  uncracked_ = averaged(intact);
  if (!parameters_.literal) rules_.uncracked = uncracked_;
  Critical critical;
  for (int t = 0; t < static_cast<int>(uncracked_.size()); ++t) {
    const double factor = load_factor(parameters_.rock, uncracked_[t]);
    if (factor < critical.load_factor) critical = {t, factor};
  }
  result_.min_safety_factor = critical.load_factor;
  if (critical.element >= 0) {
    const PrincipalStress p = principal(uncracked_[critical.element]);
    result_.failure_mode = parameters_.rock.mode(p.s1, p.s3);
  }
  result_.mean_stress = mean_stress(mesh_, intact);

  if (!std::isfinite(result_.mean_stress.xx + result_.mean_stress.yy + result_.mean_stress.xy)) {
    refuse("the stress is not finite");
  } else if (const double off = imbalance(result_.mean_stress); !(off <= kBalance)) {
    refuse(
        fmt::format("the stress does not balance the loads, by {:.2g} of them, expected within {:.0e}: the particle "
                    "is too slender for its mesh",
                    off, kBalance));
  } else if (restore_cracks() && (critical.load_factor <= 1 || !cracks_.empty()) && solve()) {
    while (!finished_ && (grow_tips() || (!finished_ && start_next_crack()))) {
    }
    if (state_.solved) result_.mean_stress = mean_stress(mesh_, state_.stress);
    if (const double left = imbalance(result_.mean_stress); state_.solved && !(left <= kBalance)) {
      refuse(
          fmt::format("the stress of the cracked particle does not balance the loads, by {:.2g} of them, expected "
                      "within {:.0e}",
                      left, kBalance));
    }
  }
  if (!finished_) {
    const bool failed_somewhere = !cracks_.empty() || critical.load_factor <= 1;
    result_.status = failed_somewhere ? ParticleStatus::arrested : ParticleStatus::intact;
  }
  // What was not analysed to its end keeps the cracks that it had.
  result_.cracks = result_.status == ParticleStatus::refused ? stored_ : std::move(cracks_);
  return std::move(result_);
}

double Analysis::first_growth() {
  double smallest = std::numeric_limits<double>::infinity();
  if (!restore_cracks() || cracks_.empty() || !solve()) return smallest;
  uncracked_ = averaged(model_.elastic.stresses(solver_.intact_displacement()));
  const std::vector<int> cutting = cutting_cracks(mesh_, cracks_);
  for (int c = 0; c < static_cast<int>(cracks_.size()); ++c) {
    for (int end = 0; end < 2; ++end) {
      if (cracks_[c].tips[end] != TipState::active) continue;
      double factor = tip_load_factor(mesh_, rules_, state_.stress, cutting, cracks_[c], end);
      const std::optional<TipDrive> drive =
          rules_.toughness > 0 ? tip_drive(model_.elastic, rules_, state_, cracks_, c, end) : std::nullopt;
      if (drive) {
        const double tough = rules_.toughness / drive->equivalent;
        // From some load on the rock ahead fails at once, and unless it is torn there, strength decides.
        const Stress& ahead = uncracked_[element_ahead(mesh_, cracks_[c], end)];
        double at_once = load_factor(rules_.rock, ahead) / kFailsAtOnce;
        if (torn(rules_.rock, {at_once * ahead.xx, at_once * ahead.yy, at_once * ahead.xy})) {
          at_once = std::numeric_limits<double>::infinity();
        }
        factor = std::min(tough, std::max(factor, at_once));
      }
      smallest = std::min(smallest, factor);
    }
  }
  return smallest;
}

}  // namespace

ParticleModel::ParticleModel(PolygonView outline_, int nodes, const ElasticConstants& constants,
                             double averaging_radius_in_de)
    : ParticleModel(outline_, make_mesh(outline_, nodes), constants, averaging_radius_in_de) {}

ParticleModel::ParticleModel(PolygonView outline_, Mesh mesh, const ElasticConstants& constants,
                             double averaging_radius_in_de)
    : outline(outline_.begin(), outline_.end()),
      area(common::area(outline_)),
      elastic(std::move(mesh), constants),
      average(elastic.mesh(), averaging_radius_in_de * common::equivalent_diameter(area)) {}

ParticleModel::ParticleModel(const CanonicalOutline& shape, int nodes, const ElasticConstants& constants,
                             double averaging_radius_in_de)
    : outline(shape.outline),
      area(common::area(shape.outline)),
      elastic(make_mesh(shape, nodes), constants),
      average(elastic.mesh(), averaging_radius_in_de * common::equivalent_diameter(area)) {}

BreakageParameters in_units_of(double length, BreakageParameters parameters) {
  parameters.minimum_area /= length * length;
  parameters.toughness /= std::sqrt(length);
  return parameters;
}

BreakageResult analyse(const ParticleModel& model, std::span<const Load> loads, std::span<const Crack> cracks,
                       const BreakageParameters& parameters) {
  std::vector<Load> scaled(loads.begin(), loads.end());
  for (Load& load : scaled) load.force *= parameters.load_factor;
  return Analysis(model, scaled, cracks, parameters).run();
}

double first_growth(const ParticleModel& model, std::span<const Load> loads, std::span<const Crack> cracks,
                    const BreakageParameters& parameters) {
  return Analysis(model, loads, cracks, parameters).first_growth();
}

}  // namespace xfem
