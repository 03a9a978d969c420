// Angular particles under forces at points of their outline: point load and multi-contact loading. There is no closed
// form; the finest mesh of a sweep is the reference.
//
// Particle: a given convex outline, or one with corners on an ellipse at seeded angles; its longest distance between
// two vertices is specimen.diameter, its centroid the origin. Point load: two opposite forces P on the line through the
// centroid along loading.direction, where it meets the outline. Estimate: the disc's load with their distance as its
// diameter, the plane form of what Hiramatsu & Oka (1966) found for irregular lumps, which fail under a point load much
// as a sphere of the same loaded diameter. Multi-contact: given forces, or random ones in balance, one in each of n
// equal parts of the perimeter, pushing inwards, with shear of at most loading.friction times normal. The load is half
// the sum of their magnitudes, which is P for two opposite forces P.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "common/error.hpp"
#include "common/geometry/center.hpp"
#include "common/math/random.hpp"
#include "xfem/lab/brazilian.hpp"
#include "xfem/lab/kinds.hpp"

namespace xfem {

namespace {

/// Of random forces until some are in balance and push; a few suffice for three or more contacts.
constexpr int kMostDraws = 10'000;
/// Random forces differ in size by at most this before they are balanced.
constexpr double kSmallestShare = 0.3;
/// Given forces must balance to this share of their sum.
constexpr double kLargestUnbalance = 1e-3;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}

Polygon generated_outline(const common::SpecimenOptions& options, common::Random& random) {
  const double spacing = 2 * std::numbers::pi / options.corners;
  const double start = random.uniform(0, 2 * std::numbers::pi);
  Polygon outline;
  for (int k = 0; k < options.corners; ++k) {
    const double angle = spacing * (k + options.roughness * random.uniform(-1, 1));
    const Vec2 on_ellipse = common::Rotation(angle) * Vec2{1, 0};
    outline.push_back(common::Rotation(start) * Vec2{on_ellipse.x(), options.aspect * on_ellipse.y()});
  }
  return outline;
}

/// From the frame of the given outline to the specimen's: scaled about the centroid, then turned.
struct Placement {
  common::Center center;
  double scale;
  common::Rotation turn;
  Vec2 operator()(const Vec2& p) const { return turn * Vec2(scale * center.to(p)); }
};

Polygon placed(const Polygon& outline, const Placement& placement) {
  Polygon result;
  for (const Vec2& p : outline) result.push_back(placement(p));
  return result;
}

/// Where the ray from the origin along the unit vector leaves the convex outline.
Vec2 exit_of_ray(PolygonView outline, const Vec2& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2 edge = outline[(i + 1) % outline.size()] - outline[i];
    const double outward = common::cross(direction, edge);
    if (outward > 0) nearest = std::min(nearest, common::cross(outline[i], edge) / outward);
  }
  return nearest * direction;
}

struct BoundaryPoint {
  Vec2 point, inwards;
};

/// A point of the outline at a share of its perimeter, and the normal there.
BoundaryPoint at_perimeter(PolygonView outline, double share) {
  double perimeter = 0;
  const auto edge = [&](std::size_t i) -> Vec2 { return outline[(i + 1) % outline.size()] - outline[i]; };
  for (std::size_t i = 0; i < outline.size(); ++i) perimeter += edge(i).norm();
  double left = share * perimeter;
  std::size_t i = 0;
  while (i + 1 < outline.size() && left > edge(i).norm()) left -= edge(i++).norm();
  const Vec2 along = edge(i) / edge(i).norm();
  return {outline[i] + left * along, common::perpendicular(along)};
}

/// Removes resultant and moment by the smallest change (least squares) of the forces.
void balance(std::vector<Load>& loads, double length) {
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Load& load : loads) {
    Eigen::Matrix<double, 3, 2> g;  // force (x, y) and moment over length of a force at the point
    g << 1, 0, 0, 1, -load.point.y() / length, load.point.x() / length;
    gram += g * g.transpose();
    sum += g * load.force;
  }
  const Eigen::Vector3d factor = gram.ldlt().solve(sum);
  for (Load& load : loads) {
    load.force.x() -= factor[0] - factor[2] * load.point.y() / length;
    load.force.y() -= factor[1] + factor[2] * load.point.x() / length;
  }
}

std::vector<Load> random_forces(PolygonView outline, const common::LabTest& test, common::Random& random) {
  const int n = test.loading.contacts;
  for (int draw = 0; draw < kMostDraws; ++draw) {
    std::vector<Load> loads;
    std::vector<Vec2> normals;
    for (int i = 0; i < n; ++i) {
      const BoundaryPoint place = at_perimeter(outline, (i + random.uniform()) / n);
      const double size = random.uniform(kSmallestShare, 1);
      const double shear = test.loading.friction * random.uniform(-1, 1);
      loads.push_back({place.point, size * (place.inwards + shear * common::perpendicular(place.inwards))});
      normals.push_back(place.inwards);
    }
    balance(loads, test.specimen.diameter);
    bool all_push = true;
    for (int i = 0; i < n; ++i) {
      const double normal = loads[i].force.dot(normals[i]);
      const double shear = std::abs(common::cross(normals[i], loads[i].force));
      all_push = all_push && normal > 0 && shear <= test.loading.friction * normal;
    }
    if (all_push) return loads;
  }
  throw common::bad_input(fmt::format(
      "{}: loading: found no {} random forces in balance with friction {} in {} draws, expected more of either",
      test.file.string(), n, test.loading.friction, kMostDraws));
}

double half_sum(const std::vector<Load>& loads) {
  double sum = 0;
  for (const Load& load : loads) sum += load.force.norm();
  return 0.5 * sum;
}

void require_balance(const std::vector<Load>& loads, const common::LabTest& test) {
  Vec2 force = Vec2::Zero();
  double moment = 0;
  for (const Load& load : loads) {
    force += load.force;
    moment += common::cross(load.point, load.force);
  }
  const double sum = 2 * half_sum(loads);
  const double unbalance = std::max(force.norm(), std::abs(moment) / test.specimen.diameter) / sum;
  if (!(unbalance <= kLargestUnbalance))
    throw common::bad_input(
        fmt::format("{}: loading.forces: found {:.2g} of their sum out of balance (force, or moment over the diameter)"
                    ", expected at most {}",
                    test.file.string(), unbalance, kLargestUnbalance));
}

/// Outline in its own frame and how it is placed, the axis at `turn` [rad] becoming y.
std::pair<Polygon, Placement> particle(const common::LabTest& test, common::Random& random, double turn) {
  const Polygon own = test.specimen.outline.empty() ? generated_outline(test.specimen, random) : test.specimen.outline;
  return {own, {common::center_of(own), test.specimen.diameter / common::diameter(own), common::Rotation(-turn)}};
}

LabSetup particle_setup(const common::LabTest& test, Polygon outline) {
  LabSetup setup;
  setup.dimensions = {{"diameter", test.specimen.diameter}, {"corners", static_cast<double>(outline.size())}};
  setup.load_patch = test.loading.patch;
  setup.outline = std::move(outline);
  return setup;
}

}  // namespace

LabSetup point_load_test(const common::LabTest& test) {
  require_loading(test, {"patch", "direction"});
  common::Random random(test.seed);
  const auto [own, placement] = particle(test, random, radians(test.loading.direction));
  LabSetup setup = particle_setup(test, placed(own, placement));
  const Vec2 top = exit_of_ray(setup.outline, {0, 1}), bottom = exit_of_ray(setup.outline, {0, -1});
  const double distance = top.y() - bottom.y();
  setup.dimensions.emplace_back("loaded_diameter", distance);
  setup.unit_load = disc_load(test.material, distance);
  setup.estimate = setup.unit_load;
  setup.estimate_source = "disc of the loaded diameter, after Hiramatsu & Oka (1966)";
  setup.loads = [top, bottom, load = setup.unit_load](const IntactModel&) {
    return std::vector<Load>{{top, {0, -load}}, {bottom, {0, load}}};
  };
  return setup;
}

LabSetup multi_contact_test(const common::LabTest& test) {
  const bool given = !test.loading.points.empty();
  require_loading(test, given ? std::vector<std::string>{"patch", "points"}
                              : std::vector<std::string>{"patch", "contacts", "friction"});
  if (given && test.specimen.outline.empty())
    throw common::bad_input(
        fmt::format("{}: specimen.outline: found none, expected the outline on which loading.points "
                    "lie",
                    test.file.string()));
  common::Random random(test.seed);
  const auto [own, placement] = particle(test, random, 0);
  LabSetup setup = particle_setup(test, placed(own, placement));
  std::vector<Load> loads;
  if (given) {
    for (std::size_t i = 0; i < test.loading.points.size(); ++i)
      loads.push_back({placement(test.loading.points[i]), test.loading.forces[i]});
    require_balance(loads, test);
  } else {
    loads = random_forces(setup.outline, test, random);
  }
  setup.dimensions.emplace_back("contacts", static_cast<double>(loads.size()));
  setup.unit_load = disc_load(test.material, test.specimen.diameter);
  const double scale = setup.unit_load / half_sum(loads);
  for (Load& load : loads) load.force *= scale;
  setup.loads = [loads](const IntactModel&) { return loads; };
  return setup;
}

}  // namespace xfem
