#include "tests/robustness/xfem/growth_walk.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "common/math/random.hpp"
#include "tests/robustness/xfem/full_system.hpp"
#include "tests/unit/xfem/outlines.hpp"
#include "xfem/crack/growth.hpp"
#include "xfem/crack/separation.hpp"

namespace growth_walks {

using namespace xfem;

namespace {

// clang-format off
constexpr Family kFamilies[] = {
    {.name = "free", .what = "rays with random kinks, clear of nodes"},
    {.name = "driven", .what = "start, tip rule, kinks, ligament rule of production in weak rock", .driven = true},
    {.name = "ragged", .what = "any edge, any place on it: U-turns, into its own crack", .kink = 1.5, .wander = 0.6},
    {.name = "nodes", .what = "every point beside a node, 1e-28 to 0.3 edges off: through nodes, along edges",
     .clear_of_nodes = false, .snap = 1},
    {.name = "some_nodes", .what = "every third point beside a node, tips on nodes",
     .clear_of_nodes = false, .snap = 0.33},
    {.name = "corners", .what = "from boundary nodes and corners inward, beside nodes",
     .clear_of_nodes = false, .snap = 0.7, .mouth = 1},
    {.name = "neighbours", .what = "cracks that share nodes, T-junctions, coalescence", .kink = 0.6, .most_cracks = 6,
     .near_others = true},
    {.name = "neighbours_nodes", .what = "the same with points beside nodes", .clear_of_nodes = false, .snap = 0.5,
     .kink = 0.6, .most_cracks = 6, .near_others = true},
    {.name = "crossing", .what = "cracks that cut the same elements, clear of nodes", .most_cracks = 3,
     .share_elements = true},
    {.name = "crossing_nodes", .what = "the same with points beside nodes", .clear_of_nodes = false, .snap = 0.5,
     .most_cracks = 3, .share_elements = true},
};
// clang-format on

class Walk {
 public:
  Walk(const Family& family, int nodes, std::int64_t number, double friction, Tally& tally)
      : family_(family),
        number_(number),
        nodes_(nodes),
        friction_(friction),
        random_(0x9e3779b97f4a7c15ull * (number + 1) + 7919 * nodes + 31 * std::strlen(family.name) + family.name[0]),
        tally_(tally),
        outline_(make_outline()),
        model_(make_mesh(outline_, nodes),
               {std::pow(10.0, random_.uniform(0, 11)), random_.uniform(0, 0.4), random_.uniform() < 0.2}),
        mesh_(model_.mesh()),
        patch_(random_.uniform() < 0.3 ? random_.uniform(0.02, 0.2) * std::sqrt(common::area(outline_)) : 0.0),
        loads_(make_loads()),
        solver_(model_, loads_, patch_, friction_),
        rules_{HoekBrown{1.0, 25}, 0.1 * std::sqrt(common::area(outline_)), random_.uniform() < 0.2, {}} {}

  void run(int steps, int every);

 private:
  common::Polygon make_outline();
  std::vector<Load> make_loads();
  double snapped(double fraction);
  CrackPoint point(int a, int b, double fraction);
  bool fits(const Crack& crack, const std::vector<int>& cutting, int own) const;
  std::optional<Crack> new_crack();
  std::optional<Crack> grown(int crack, int end);
  bool take(std::size_t crack, Crack value, int end);
  bool check(int every);
  void fail(std::int64_t& count, const char* what);

  const Family& family_;
  const std::int64_t number_;
  const int nodes_;
  const double friction_;
  common::Random random_;
  Tally& tally_;
  const common::Polygon outline_;
  const IntactModel model_;
  const Mesh& mesh_;
  const double patch_;
  const std::vector<Load> loads_;
  CrackedSolver solver_;
  const GrowthRules rules_;
  std::vector<Crack> cracks_;
  CrackedState state_;
};

common::Polygon Walk::make_outline() {
  common::Polygon outline = test_outlines::random_outline(random_, random_.uniform(0.3, 1));
  const double size = std::pow(10.0, random_.uniform(-3, 3));
  for (common::Vec2& vertex : outline) vertex *= size;
  return outline;
}

std::vector<Load> Walk::make_loads() {
  std::vector<Load> loads;
  const int count = 2 + static_cast<int>(random_.index(5));
  const double size = std::pow(10.0, random_.uniform(0, 8));
  for (int i = 0; i < count; ++i) {
    const std::size_t edge = random_.index(outline_.size());
    const Vec2& a = outline_[edge];
    const Vec2 along = outline_[(edge + 1) % outline_.size()] - a;
    loads.push_back({a + random_.uniform() * along, size * Vec2(random_.uniform(-1, 1), random_.uniform(-1, 1))});
  }
  return loads;
}

/// The fraction, or for a share of them a place as far from the nearer node as is drawn.
double Walk::snapped(double fraction) {
  if (random_.uniform() >= family_.snap) return fraction;
  const double offset = std::max(1e-28, 0.3 * std::pow(10.0, random_.uniform(-28, 0)));
  return fraction < 0.5 ? offset : 1 - offset;
}

CrackPoint Walk::point(int a, int b, double fraction) {
  fraction = snapped(fraction);
  if (family_.clear_of_nodes) return point_on_edge(mesh_, a, b, fraction);
  if (a > b) {
    std::swap(a, b);
    fraction = 1 - fraction;
  }
  fraction = std::clamp(fraction, 1e-28, 1 - 0x1p-53);
  return {{a, b}, fraction, mesh_.nodes[a] + fraction * (mesh_.nodes[b] - mesh_.nodes[a])};
}

bool Walk::fits(const Crack& crack, const std::vector<int>& cutting, int own) const {
  if (!crack_defect(mesh_, crack).empty()) return false;
  if (family_.share_elements) return true;
  for (std::size_t i = 1; i < crack.points.size(); ++i) {
    const int other = cutting[segment_element(mesh_, crack.points[i - 1], crack.points[i])];
    if (other >= 0 && other != own) return false;
  }
  return true;
}

/// One element, or two if it starts at the boundary, where the first one must not be cut off.
std::optional<Crack> Walk::new_crack() {
  const std::vector<int> cutting = cutting_cracks(mesh_, cracks_);
  int element = static_cast<int>(random_.index(mesh_.triangles.size()));
  if (family_.driven) {
    if (cutting[element] >= 0) return std::nullopt;
    return start_crack(mesh_, rules_, state_.stress, element);
  }
  const bool mouth = random_.uniform() < family_.mouth;
  if (family_.near_others && !cracks_.empty() && random_.uniform() < 0.8) {
    const std::vector<CrackPoint>& points = cracks_[random_.index(cracks_.size())].points;
    const int node = points[random_.index(points.size())].edge[random_.index(2)];
    const int around = mesh_.element_offset[node + 1] - mesh_.element_offset[node];
    element = mesh_.node_elements[mesh_.element_offset[node] + static_cast<int>(random_.index(around))];
  } else if (mouth) {
    const int node = static_cast<int>(random_.index(boundary_loop(mesh_).size()));  // the boundary nodes come first
    element = mesh_.node_elements[mesh_.element_offset[node]];
  }
  int side = static_cast<int>(random_.index(3));
  for (int k = 0; mouth && k < 3; ++k) {
    if (mesh_.neighbours[element][k] < 0) side = k;
  }
  const auto& triangle = mesh_.triangles[element];
  const int apex = triangle[side], a = triangle[(side + 1) % 3], b = triangle[(side + 2) % 3];
  Crack crack;
  crack.points = {point(a, b, random_.uniform()), point(random_.uniform() < 0.5 ? a : b, apex, random_.uniform())};
  for (int end = 0; end < 2; ++end) {
    if (on_boundary(mesh_, crack.points[end])) crack.tips[end] = TipState::at_boundary;
  }
  if (!fits(crack, cutting, -1)) return std::nullopt;
  return crack;
}

/// The crack with one more point at one end; empty if none that is tried fits.
std::optional<Crack> Walk::grown(int index, int end) {
  const std::vector<int> cutting = cutting_cracks(mesh_, cracks_);
  if (family_.driven) {
    const TipStep step = advance_tip(mesh_, outline_, rules_, state_.stress, cutting, cracks_, index, end);
    if (step.outcome == TipOutcome::arrested || step.outcome == TipOutcome::stays) return std::nullopt;
    return step.crack;
  }
  const Crack& crack = cracks_[index];
  const CrackPoint& tip = end == 0 ? crack.points.front() : crack.points.back();
  const CrackPoint& before = end == 0 ? crack.points[1] : crack.points[crack.points.size() - 2];
  const int next = element_ahead(mesh_, crack, end);
  if (next < 0) return std::nullopt;
  if (!family_.share_elements && cutting[next] >= 0 && cutting[next] != index) {
    Crack merged = crack;
    merged.tips[end] = TipState::at_crack;
    return merged;
  }
  const int k = mesh_.local_edge(next, tip.edge[0], tip.edge[1]);
  const auto& triangle = mesh_.triangles[next];
  const int apex = triangle[k], left = triangle[(k + 1) % 3], right = triangle[(k + 2) % 3];
  const double turn = family_.kink * random_.uniform(-1, 1);
  const Vec2 chord = tip.position - before.position;
  const Vec2 direction(std::cos(turn) * chord.x() - std::sin(turn) * chord.y(),
                       std::sin(turn) * chord.x() + std::cos(turn) * chord.y());
  const bool any = random_.uniform() < family_.wander;
  const bool to_right = any ? random_.uniform() < 0.5 : common::cross(direction, mesh_.nodes[apex] - tip.position) > 0;
  for (const int from : {to_right ? right : left, to_right ? left : right}) {
    const Vec2 edge = mesh_.nodes[apex] - mesh_.nodes[from];
    double fraction = common::cross(tip.position - mesh_.nodes[from], direction) / common::cross(edge, direction);
    if (any || !(fraction > 0 && fraction < 1)) fraction = random_.uniform();
    Crack trial = crack;
    const CrackPoint exit = point(from, apex, fraction);
    trial.points.insert(end == 0 ? trial.points.begin() : trial.points.end(), exit);
    if (on_boundary(mesh_, exit)) trial.tips[end] = TipState::at_boundary;
    if (fits(trial, cutting, index)) return trial;
  }
  return std::nullopt;
}

void Walk::fail(std::int64_t& count, const char* what) {
  ++count;
  tally_.failures.push_back(std::string(family_.name) + ":" + std::to_string(nodes_) + ":" + std::to_string(number_) +
                            " step " + std::to_string(tally_.steps) + " " + what);
}

/// Solves and checks; false if the state cannot stay.
bool Walk::check(int every) {
  ++tally_.steps;
  state_ = solver_.solve(cracks_);
  if (every > 0 && tally_.steps % every == 0) {
    const CrackedState alone = CrackedSolver(model_, loads_, patch_, friction_).solve(cracks_);
    bool same = alone.solved == state_.solved && alone.u == state_.u && alone.q == state_.q &&
                alone.stress.size() == state_.stress.size();
    for (std::size_t t = 0; same && t < alone.stress.size(); ++t) {
      same = std::memcmp(&alone.stress[t], &state_.stress[t], sizeof(Stress)) == 0;
    }
    if (!same) fail(tally_.impure, "differs from a new solver");
  }
  if (!state_.solved) {
    if (is_separated(mesh_, cracks_, state_.enrichment)) {
      ++tally_.separated;
    } else if (smallest_eigenvalue(model_, state_.enrichment) < kLooseEigenvalue) {
      ++tally_.hinged;
    } else {
      fail(tally_.singular, "singular in one piece");
    }
    return false;
  }
  if (!state_.settled) {
    fail(tally_.unsettled, "contact does not settle");
    return false;
  }
  const Residual residual = residual_of(model_, loads_, patch_, outline_, state_);
  if (!residual.is_finite) fail(tally_.not_finite, "not finite");
  if (residual.scaled > (friction_ > 0 ? kFrictionResidualLimit : kResidualLimit)) fail(tally_.over_limit, "residual");
  if (residual.virial > kVirialLimit * residual.amplification) fail(tally_.virial_over_limit, "virial");
  if (residual.scaled > tally_.worst_residual) tally_.worst_walk = number_;
  tally_.worst_residual = std::max(tally_.worst_residual, residual.scaled);
  tally_.worst_over_load = std::max(tally_.worst_over_load, residual.over_load);
  tally_.worst_virial = std::max(tally_.worst_virial, residual.virial);
  tally_.turned += residual.over_load > 1e-10;
  tally_.closed += state_.closed_segments > 0;
  tally_.most_functions =
      std::max(tally_.most_functions, static_cast<std::int64_t>(state_.enrichment.functions.size()));
  for (const CutElement& element : state_.enrichment.cut) {
    for (const ElementPart& part : element.parts) {
      tally_.smallest_part = std::min(tally_.smallest_part, part.area / mesh_.areas[element.element]);
    }
  }
  return true;
}

void Walk::run(int steps, int every) {
  ++tally_.walks;
  state_ = solver_.solve({});
  for (int step = 0; step < steps; ++step) {
    struct Tip {
      int crack, end;
    };
    std::vector<Tip> tips;
    for (std::size_t c = 0; c < cracks_.size(); ++c) {
      for (int end = 0; end < 2; ++end) {
        if (cracks_[c].tips[end] == TipState::active) tips.push_back({static_cast<int>(c), end});
      }
    }
    const bool may_start = static_cast<int>(cracks_.size()) < family_.most_cracks;
    if (may_start && (tips.empty() || random_.uniform() < 0.1)) {
      std::optional<Crack> crack = new_crack();
      if (!crack) {
        ++tally_.refused;
        continue;
      }
      cracks_.push_back(std::move(*crack));
      if (check(every)) continue;
      cracks_.pop_back();
      state_ = solver_.solve(cracks_);
      continue;
    }
    if (tips.empty()) return;
    const auto [index, end] = tips[random_.index(tips.size())];
    std::optional<Crack> next = grown(index, end);
    if (!next) {
      ++tally_.refused;
      cracks_[index].tips[end] = TipState::arrested;
      continue;
    }
    if (next->points.size() == cracks_[index].points.size()) {
      ++tally_.merged;
      cracks_[index] = std::move(*next);
      continue;
    }
    Crack before = cracks_[index];
    cracks_[index] = std::move(*next);
    if (check(every)) continue;
    cracks_[index] = std::move(before);
    cracks_[index].tips[end] = TipState::arrested;
    state_ = solver_.solve(cracks_);
  }
}

}  // namespace

std::span<const Family> families() {
  return kFamilies;
}

const Family* family_named(const std::string& name) {
  for (const Family& family : kFamilies) {
    if (name == family.name) return &family;
  }
  return nullptr;
}

void Tally::add(const Tally& other) {
  walks += other.walks;
  steps += other.steps;
  separated += other.separated;
  hinged += other.hinged;
  singular += other.singular;
  refused += other.refused;
  merged += other.merged;
  impure += other.impure;
  not_finite += other.not_finite;
  over_limit += other.over_limit;
  unsettled += other.unsettled;
  virial_over_limit += other.virial_over_limit;
  turned += other.turned;
  closed += other.closed;
  if (other.worst_residual > worst_residual) worst_walk = other.worst_walk;
  worst_residual = std::max(worst_residual, other.worst_residual);
  worst_over_load = std::max(worst_over_load, other.worst_over_load);
  worst_virial = std::max(worst_virial, other.worst_virial);
  smallest_part = std::min(smallest_part, other.smallest_part);
  most_functions = std::max(most_functions, other.most_functions);
  for (const std::string& failure : other.failures) {
    if (failures.size() < 20) failures.push_back(failure);
  }
}

Tally walk(const Family& family, int nodes, std::int64_t number, int steps, int every, double friction) {
  Tally tally;
  Walk(family, nodes, number, friction, tally).run(steps, every);
  return tally;
}

}  // namespace growth_walks
