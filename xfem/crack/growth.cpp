#include "xfem/crack/growth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/vec2.hpp"

namespace xfem {
namespace {

using common::cross;

const double kHalfRoot = std::sqrt(0.5);

/// The uncut elements that decide on a tip: the one across the tip edge, and those around the edge's nodes whose
/// centroid lies ahead of the tip.
std::vector<int> elements_ahead(const Mesh& mesh, std::span<const int> cutting, const CrackPoint& tip, int next,
                                const Vec2& direction, bool literal) {
  std::vector<int> found{next};
  if (literal) return found;
  for (const int node : tip.edge) {
    for (int i = mesh.element_offset[node]; i < mesh.element_offset[node + 1]; ++i) {
      const int t = mesh.node_elements[i];
      if (cutting[t] >= 0 || std::find(found.begin(), found.end(), t) != found.end()) continue;
      if ((mesh.centroid(t) - tip.position).dot(direction) > 0) found.push_back(t);
    }
  }
  return found;
}

/// The direction, turned back to 45 degrees from `previous` if it kinks by more.
Vec2 without_sharp_kink(const Vec2& direction, const Vec2& previous) {
  if (direction.dot(previous) >= kHalfRoot) return direction;
  const double turn = cross(previous, direction) >= 0 ? 1 : -1;
  return kHalfRoot * (previous + turn * common::perpendicular(previous));
}

/// Direction of growth under the stress that decides.
Vec2 growth_direction(const GrowthRules& rules, const Stress& stress, const Vec2& previous) {
  const PrincipalStress state = principal(stress);
  if (!std::isfinite(rules.rock.load_factor(state.s1, state.s3))) return previous;
  const HoekBrown::Planes planes = rules.rock.planes(state);
  const double first = planes.first.dot(previous);
  const double second = planes.second.dot(previous);
  const bool take_first = std::abs(first) >= std::abs(second);
  Vec2 direction = take_first ? planes.first : planes.second;
  if ((take_first ? first : second) < 0) direction = -direction;
  return rules.literal ? direction : without_sharp_kink(direction, previous);
}

/// Chord of a crack on which kinks are measured.
Vec2 last_direction(const Mesh& mesh, const GrowthRules& rules, const Crack& crack) {
  return tip_direction(crack, rules.literal ? 0 : mesh.size);
}

/// Direction of growth by strength; empty if nothing ahead of the tip fails.
std::optional<Vec2> failing_direction(const Mesh& mesh, const GrowthRules& rules, std::span<const Stress> stress,
                                      std::span<const int> cutting, const Crack& crack, int next,
                                      const Vec2& previous) {
  bool fails = false;
  Stress mean;
  double area = 0;
  for (const int t : elements_ahead(mesh, cutting, crack.points.back(), next, previous, rules.literal)) {
    fails = fails || load_factor(rules.rock, stress[t]) < 1;
    mean.xx += mesh.areas[t] * stress[t].xx;
    mean.yy += mesh.areas[t] * stress[t].yy;
    mean.xy += mesh.areas[t] * stress[t].xy;
    area += mesh.areas[t];
  }
  if (!fails) return std::nullopt;
  mean = {mean.xx / area, mean.yy / area, mean.xy / area};
  return growth_direction(rules, fails_at_once(rules, next) ? rules.uncracked[next] : mean, previous);
}

/// The point at which the ray from the tip leaves the element `next`, or, if the crack would not be valid with it,
/// the nearest point of the other edge; empty if neither is.
std::optional<CrackPoint> exit_point(const Mesh& mesh, const Crack& crack, int next, const Vec2& direction,
                                     const Vec2& previous, bool literal) {
  const CrackPoint& tip = crack.points.back();
  const auto& triangle = mesh.triangles[next];
  const int k = mesh.local_edge(next, tip.edge[0], tip.edge[1]);
  const int apex = triangle[k];
  const int left = triangle[(k + 1) % 3];  // as seen from the tip, looking into the element
  const int right = triangle[(k + 2) % 3];
  const Vec2 to_apex = mesh.nodes[apex] - tip.position;
  const bool leaves_right = cross(direction, to_apex) > 0;
  const int side = leaves_right ? right : left;
  const int other = leaves_right ? left : right;

  const Vec2 inward = common::perpendicular(mesh.nodes[right] - mesh.nodes[left]);
  double fraction = 0;  // of the way from `side` to the apex; 0 if the ray does not enter the element
  if (direction.dot(inward) > 0) {
    const Vec2 edge = mesh.nodes[apex] - mesh.nodes[side];
    const double denominator = cross(edge, direction);
    if (denominator != 0) fraction = cross(tip.position - mesh.nodes[side], direction) / denominator;
  }
  for (const CrackPoint& point : {point_on_edge(mesh, side, apex, fraction), point_on_edge(mesh, other, apex, 1.0)}) {
    if (!literal && (point.position - tip.position).dot(previous) <= 0) continue;
    Crack trial = crack;
    trial.points.push_back(point);
    if (crack_defect(mesh, trial).empty()) return point;
  }
  return std::nullopt;
}

/// Distance from an inner point along a unit ray to the boundary of the convex outline.
double distance_to_boundary(PolygonView outline, const Vec2& from, const Vec2& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    const double outward = cross(direction, edge);
    if (outward > 0) nearest = std::min(nearest, cross(outline[i] - from, edge) / outward);
  }
  return std::max(0.0, nearest);
}

/// The crack continued straight until it meets the boundary or another crack; unchanged if it cannot get there.
Crack straight_through(const Mesh& mesh, std::span<const int> cutting, const Crack& crack, const Vec2& direction) {
  Crack result = crack;
  for (std::size_t step = 0; step < mesh.triangles.size(); ++step) {
    const int next = element_ahead(mesh, result, 1);
    if (next < 0) {
      result.tips[1] = TipState::at_boundary;
      return result;
    }
    if (cutting[next] >= 0) {
      result.tips[1] = TipState::at_crack;
      return result;
    }
    const std::optional<CrackPoint> point = exit_point(mesh, result, next, direction, direction, false);
    if (!point) break;
    result.points.push_back(*point);
  }
  return crack;
}

}  // namespace

Crack oriented(const Crack& crack, int end) {
  Crack result = crack;
  if (end == 0) {
    std::reverse(result.points.begin(), result.points.end());
    std::swap(result.tips[0], result.tips[1]);
  }
  return result;
}

Vec2 tip_direction(const Crack& crack, double length) {
  const Vec2& tip = crack.points.back().position;
  Vec2 chord = Vec2::Zero();
  for (std::size_t i = crack.points.size() - 1; i-- > 0;) {
    chord = tip - crack.points[i].position;
    if (chord.squaredNorm() >= length * length) break;
  }
  return chord / chord.norm();
}

double load_factor(const HoekBrown& rock, const Stress& stress) {
  const PrincipalStress state = principal(stress);
  return rock.load_factor(state.s1, state.s3);
}

bool fails_at_once(const GrowthRules& rules, int element) {
  return !rules.uncracked.empty() && load_factor(rules.rock, rules.uncracked[element]) <= kFailsAtOnce;
}

std::vector<int> cutting_cracks(const Mesh& mesh, std::span<const Crack> cracks) {
  std::vector<int> cutting(mesh.triangles.size(), -1);
  for (std::size_t c = 0; c < cracks.size(); ++c) {
    for (std::size_t i = 0; i + 1 < cracks[c].points.size(); ++i) {
      const int element = segment_element(mesh, cracks[c].points[i], cracks[c].points[i + 1]);
      if (element >= 0 && cutting[element] < 0) cutting[element] = static_cast<int>(c);
    }
  }
  return cutting;
}

int element_ahead(const Mesh& mesh, const Crack& crack, int end) {
  const std::size_t n = crack.points.size();
  const CrackPoint& tip = end == 0 ? crack.points[0] : crack.points[n - 1];
  const CrackPoint& before = end == 0 ? crack.points[1] : crack.points[n - 2];
  const int last = segment_element(mesh, before, tip);
  const std::array<int, 2> sides = edge_elements(mesh, tip.edge);
  return sides[0] == last ? sides[1] : sides[0];
}

std::optional<Crack> start_crack(const Mesh& mesh, const GrowthRules& rules, std::span<const Stress> stress,
                                 int element) {
  const HoekBrown::Planes planes = rules.rock.planes(principal(stress[element]));
  const auto& triangle = mesh.triangles[element];
  const Vec2 center = mesh.centroid(element);
  std::optional<Crack> best;
  double best_need = -1;
  for (const Vec2& along : {planes.first, planes.second}) {
    std::array<double, 3> distance;
    for (int k = 0; k < 3; ++k) distance[k] = cross(along, mesh.nodes[triangle[k]] - center);
    int lone = 0;
    while ((distance[(lone + 1) % 3] >= 0) != (distance[(lone + 2) % 3] >= 0)) ++lone;
    Crack crack;
    for (const int step : {1, 2}) {
      const int k = (lone + step) % 3;
      const double fraction = distance[lone] / (distance[lone] - distance[k]);
      crack.points.push_back(point_on_edge(mesh, triangle[lone], triangle[k], fraction));
    }
    double need = 0;
    for (int end = 0; end < 2; ++end) {
      const int next = element_ahead(mesh, crack, end);
      if (next < 0) {
        crack.tips[end] = TipState::at_boundary;
      } else {
        need += 1 / load_factor(rules.rock, stress[next]);
      }
    }
    if (crack.tips[0] == TipState::at_boundary && crack.tips[1] == TipState::at_boundary) continue;
    if (need > best_need) {
      best = crack;
      best_need = need;
    }
  }
  return best;
}

double tip_load_factor(const Mesh& mesh, const GrowthRules& rules, std::span<const Stress> stress,
                       std::span<const int> cutting, const Crack& crack, int end) {
  const Crack current = oriented(crack, end);
  const int next = element_ahead(mesh, current, 1);
  if (next < 0 || cutting[next] >= 0) return 0;
  double smallest = std::numeric_limits<double>::infinity();
  const Vec2 previous = last_direction(mesh, rules, current);
  for (const int t : elements_ahead(mesh, cutting, current.points.back(), next, previous, rules.literal)) {
    smallest = std::min(smallest, load_factor(rules.rock, stress[t]));
  }
  return smallest;
}

bool at_ligament(const Mesh& mesh, PolygonView outline, const GrowthRules& rules, const Crack& crack, int end) {
  const Crack current = oriented(crack, end);
  const Vec2& tip = current.points.back().position;
  return distance_to_boundary(outline, tip, last_direction(mesh, rules, current)) <= rules.ligament + mesh.size;
}

TipStep advance_tip(const Mesh& mesh, PolygonView outline, const GrowthRules& rules, std::span<const Stress> stress,
                    std::span<const int> cutting, std::span<const Crack> cracks, int crack, int end,
                    const std::optional<DrivenTip>& driven) {
  Crack current = oriented(cracks[crack], end);
  TipStep step;
  const auto finish = [&](TipOutcome outcome, Crack after, Crack fallback) {
    step.outcome = outcome;
    fallback.tips[1] = TipState::arrested;
    step.crack = oriented(after, end);
    step.fallback = oriented(fallback, end);
    return step;
  };
  const auto with_tip = [](Crack value, TipState state) {
    value.tips[1] = state;
    return value;
  };

  const int next = element_ahead(mesh, current, 1);
  if (next < 0) return finish(TipOutcome::through, with_tip(current, TipState::at_boundary), current);
  if (cutting[next] == crack) return finish(TipOutcome::arrested, with_tip(current, TipState::arrested), current);
  if (cutting[next] >= 0) return finish(TipOutcome::merged, with_tip(current, TipState::at_crack), current);

  const Vec2 previous = last_direction(mesh, rules, current);
  Vec2 direction;
  if (driven) {
    if (!driven->advances) return finish(TipOutcome::stays, current, current);
    // What is left of the particle turns the stress at a tip there.
    direction = at_ligament(mesh, outline, rules, cracks[crack], end) ? previous
                                                                      : without_sharp_kink(driven->direction, previous);
  } else {
    const std::optional<Vec2> failing = failing_direction(mesh, rules, stress, cutting, current, next, previous);
    if (!failing) return finish(TipOutcome::stays, current, current);
    direction = *failing;
  }
  const std::optional<CrackPoint> point = exit_point(mesh, current, next, direction, previous, rules.literal);
  if (!point) return finish(TipOutcome::arrested, with_tip(current, TipState::arrested), current);
  Crack grown = current;
  grown.points.push_back(*point);
  if (on_boundary(mesh, *point)) return finish(TipOutcome::through, with_tip(grown, TipState::at_boundary), current);
  if (!rules.literal && distance_to_boundary(outline, point->position, direction) <= rules.ligament) {
    const Crack reached = straight_through(mesh, cutting, grown, direction);
    if (reached.tips[1] == TipState::at_boundary) return finish(TipOutcome::through, reached, grown);
    if (reached.tips[1] == TipState::at_crack) return finish(TipOutcome::merged, reached, grown);
  }
  return finish(TipOutcome::grown, grown, grown);
}

}  // namespace xfem
