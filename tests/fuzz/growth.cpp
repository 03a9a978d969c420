#include <fmt/format.h>

#include <numeric>

#include "tests/fuzz/draws.hpp"
#include "tests/physics/xfem/crack/result_defect.hpp"
#include "tests/robustness/xfem/full_system.hpp"
#include "tests/robustness/xfem/growth_walk.hpp"
#include "xfem/breakage.hpp"
#include "xfem/crack/cracked_solver.hpp"

namespace fuzz {
namespace {

using common::ParticleStatus;
using common::Polygon;
using common::Vec2;
using namespace xfem;

/// The limits of the growth walks hold for meshes whose angles all have a sine of at least this. What a sliver's badly
/// conditioned system leaves is bounded by the analysis itself, which refuses when it is too much.
constexpr double kRegularSine = 0.25;
constexpr double kSliverVirial = 1e-6;

double smallest_sine(const Mesh& mesh) {
  double smallest = 1;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 a = mesh.nodes[t[(k + 1) % 3]] - mesh.nodes[t[k]], b = mesh.nodes[t[(k + 2) % 3]] - mesh.nodes[t[k]];
      smallest = std::min(smallest, common::cross(a, b) / (a.norm() * b.norm()));
    }
  }
  return smallest;
}

std::vector<Load> loads_on(Draws& draws, const Polygon& outline) {
  std::vector<Load> loads;
  const int count = draws.integer(0, 9);
  for (int k = 0; k < count; ++k) {
    const std::size_t edge = draws.byte() % outline.size();
    const Vec2& from = outline[edge];
    const Vec2 along = outline[(edge + 1) % outline.size()] - from;
    const Vec2 in = common::perpendicular(along).normalized();
    const double size = draws.one_in(16) ? draws.magnitude(-60, 60) : 1e6 * draws.unit();
    const double slope = draws.uniform(-1, 1);
    Load load{from + draws.unit() * along, size * (in + slope * along.normalized())};
    if (draws.one_in(16)) load.point += Vec2{draws.magnitude(-50, 1), draws.magnitude(-50, 1)};
    loads.push_back(load);
  }
  // Every second set in balance: each force has its opposite, on the line through the centroid or not.
  if (draws.flag()) {
    for (Load& load : std::vector<Load>(loads)) loads.push_back({-load.point, -load.force});
  }
  return loads;
}

/// A crack as a file might have it: through given points, or any points on any edges with any tips.
void add_stored(Draws& draws, const Mesh& mesh, double size, std::vector<Crack>& cracks) {
  const auto tip = [&draws] { return static_cast<TipState>(draws.integer(0, 3)); };
  const std::array<TipState, 2> tips{tip(), tip()};
  if (draws.flag()) {
    std::vector<Vec2> line;
    for (int points = draws.integer(2, 5); points > 0; --points) {
      line.push_back(size * Vec2{draws.uniform(-1, 1), draws.uniform(-1, 1)});
    }
    const Crack crack = place_polyline(mesh, line, tips);
    require(crack.points.empty() || crack.points.size() >= 2, "a placed crack of one point");
    if (!crack.points.empty()) {
      const std::string defect = crack_defect(mesh, crack);
      if (!defect.empty()) wrong("a placed crack: " + defect);
      cracks.push_back(crack);
    }
    return;
  }
  Crack crack;
  crack.tips = tips;
  int element = draws.byte() % static_cast<int>(mesh.triangles.size());
  int entered = draws.integer(0, 2);
  for (int points = draws.integer(1, 9); points > 0 && element >= 0; --points) {
    const auto& nodes = mesh.triangles[element];
    const int a = nodes[(entered + 1) % 3], b = nodes[(entered + 2) % 3];
    CrackPoint point = point_on_edge(mesh, a, b, draws.unit());
    if (draws.one_in(16)) {
      point.fraction = draws.one_in(4) ? draws.unit() : std::ldexp(1, -draws.integer(1, 60));
      point.position =
          mesh.nodes[point.edge[0]] + point.fraction * (mesh.nodes[point.edge[1]] - mesh.nodes[point.edge[0]]);
    }
    crack.points.push_back(point);
    const int next = mesh.neighbours[element][entered];
    if (crack.points.size() > 1 || draws.flag()) {
      element = next;
      if (element < 0) break;
      for (int k = 0; k < 3; ++k) {
        if (mesh.triangles[element][k] != a && mesh.triangles[element][k] != b) entered = (k + draws.integer(1, 2)) % 3;
      }
    } else {
      entered = (entered + draws.integer(1, 2)) % 3;
    }
  }
  cracks.push_back(crack);
}

/// The state that the result says it is in, solved anew: the result's mean stress to the last bit, and against the
/// whole enriched system as in tests/robustness/xfem. Face friction is no part of that oracle.
void check_state(const ParticleModel& model, std::span<const Load> loads, const BreakageParameters& parameters,
                 const BreakageResult& result) {
  const double patch = parameters.literal ? 0 : parameters.load_patch * common::equivalent_diameter(model.area);
  const double friction = parameters.literal ? 0 : parameters.face_friction;
  const CrackedState state = CrackedSolver(model.elastic, loads, patch, friction).solve(result.cracks);
  require(state.solved && state.settled, "a result whose state has no solution");
  const Stress mean = mean_stress(model.elastic.mesh(), state.stress);
  require(mean.xx == result.mean_stress.xx && mean.yy == result.mean_stress.yy && mean.xy == result.mean_stress.xy,
          "the mean stress depends on the way to the state");
  const double force = std::accumulate(loads.begin(), loads.end(), 0.0,
                                       [](double sum, const Load& load) { return sum + load.force.norm(); });
  if (friction > 0 || force == 0) return;
  const growth_walks::Residual residual = growth_walks::residual_of(model.elastic, loads, patch, model.outline, state);
  const bool regular = smallest_sine(model.elastic.mesh()) >= kRegularSine;
  const bool balanced = regular ? residual.scaled <= growth_walks::kResidualLimit &&
                                      residual.virial <= growth_walks::kVirialLimit * residual.amplification
                                : residual.virial <= kSliverVirial;
  if (residual.is_finite && balanced) return;
  wrong(
      fmt::format("finite {}, residual {:.3g}, mean stress off the virial by {:.3g} of the loads, amplification {:.3g}",
                  residual.is_finite, residual.scaled, residual.virial, residual.amplification));
}

void examine(const ParticleModel& model, std::span<const Load> loads, std::span<const Crack> stored,
             const BreakageParameters& parameters, const BreakageResult& result) {
  const bool refused = result.status == ParticleStatus::refused;
  if (refused) {
    require(!result.reason.empty(), "refused without a reason");
    require(result_check::same_cracks(result.cracks, {stored.begin(), stored.end()}),
            "a refused particle does not keep its cracks");
    return;
  }
  const std::string defect = result_check::result_defect(model, result, parameters, stored.size());
  if (!defect.empty()) wrong(defect);
  require(result.min_safety_factor >= 0, "safety factor");
  if (result.status == ParticleStatus::intact) require(result.cracks.empty(), "intact with cracks");
  if (result.status == ParticleStatus::broken || result.cracks.empty()) return;
  std::vector<Load> scaled(loads.begin(), loads.end());
  for (Load& load : scaled) load.force *= parameters.load_factor;
  check_state(model, scaled, parameters, result);
}

}  // namespace

void growth(Input input) {
  Draws draws(input);
  const double size = draws.one_in(16) ? std::ldexp(1, draws.integer(-20, 20)) : draws.uniform(0.1, 0.3);
  Polygon outline = draws.polygon(10);
  for (Vec2& v : outline) v *= size;
  if (!common::outline_defect(outline).empty()) return;
  const Vec2 center = common::centroid(outline);
  for (Vec2& v : outline) v -= center;
  if (!common::outline_defect(outline).empty()) return;
  const int nodes = draws.integer(20, 75);
  const ElasticConstants constants{20e9, draws.one_in(8) ? draws.uniform(0, 0.499) : 0.2, draws.one_in(8)};
  BreakageParameters parameters;
  parameters.initiation_radius = draws.one_in(4) ? draws.unit() : 0.1;
  parameters.minimum_area = 0;
  parameters.minimum_fragment = draws.one_in(4) ? 0.5 * draws.unit() : 0.03;
  parameters.max_cracks = draws.integer(1, 5);
  parameters.literal = draws.one_in(5);
  parameters.load_patch = draws.one_in(4) ? draws.unit() : 0;
  parameters.face_friction = draws.one_in(4) ? 2 * draws.unit() : 0;
  parameters.toughness = draws.one_in(4) ? 1e6 * std::sqrt(size) * draws.unit() : 0;
  if (draws.one_in(4)) parameters.rock = {150e6, draws.uniform(1, 40)};

  std::optional<ParticleModel> model;
  if (!unless_refused([&] { model.emplace(outline, nodes, constants, parameters.initiation_radius); })) return;
  const std::vector<Load> loads = loads_on(draws, outline);
  std::vector<Crack> stored;
  for (int cracks = draws.one_in(2) ? draws.integer(0, 4) : 0; cracks > 0; --cracks) {
    add_stored(draws, model->elastic.mesh(), size, stored);
  }

  // Near the first failure of the unit loads, where the walk is longest, or far beyond it.
  const BreakageResult unit = analyse(*model, loads, {}, parameters);
  if (unit.status == ParticleStatus::refused) return;
  const double first = std::isfinite(unit.min_safety_factor) && unit.min_safety_factor > 0 ? unit.min_safety_factor : 1;
  double level = first * (1 + draws.unit());
  std::vector<Load> now = loads;
  for (int frame = draws.integer(1, 4); frame > 0; --frame) {
    parameters.load_factor = level;
    const BreakageResult result = analyse(*model, now, stored, parameters);
    examine(*model, now, stored, parameters, result);
    const double growth_at = first_growth(*model, now, stored, parameters);
    require(growth_at >= 0, "load factor of first growth");
    if (result.status == ParticleStatus::broken || result.status == ParticleStatus::refused) return;
    const BreakageResult again = analyse(*model, now, result.cracks, parameters);
    examine(*model, now, result.cracks, parameters, again);
    require(again.status == result.status, "another status when the cracks are loaded again");
    require(again.growth_steps == 0, "growth when the cracks are loaded again");
    require(result_check::same_cracks(again.cracks, result.cracks), "other cracks when they are loaded again");
    stored = result.cracks;
    // The next frame: other forces at the same places, turned or grown.
    level *= draws.one_in(8) ? std::ldexp(1, draws.integer(0, 10)) : 1 + draws.unit();
    const common::Rotation turn(draws.one_in(3) ? draws.uniform(-1, 1) : 0);
    for (Load& load : now) load.force = turn * load.force;
  }
}

}  // namespace fuzz
