#include "dem/stages/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/geometry/center.hpp"
#include "dem/stages/hilbert.hpp"

namespace dem {
namespace {

constexpr double kTwoPi = 6.283185307179586;
/// Steps of this size (modulo 1) fill the unit interval evenly, whatever their number.
constexpr double kGoldenFraction = 0.6180339887498949;
/// Share of the circle that solids fill in the first attempt; random placement jams a little above it.
constexpr double kFirstSolidFraction = 0.58;
constexpr int kTrials = 10000;
constexpr double kGrowth = 1.02;

/// Beside an edge as short as this, a corner as flat as that (both in diameters) is left out.
constexpr double kShortEdge = 1e-4;
constexpr double kFlat = 1e-12;

/// Leaves out the corners of an outline of diameter 1 that are straight, to rounding, beside a short edge. Points that
/// a drawing has twice on a straight edge make such corners: the line along the edge between them, along which contacts
/// are clipped, turns by rounding over its length, and cuts into the outline at the far end of the long edge.
void leave_out_flat_corners(Polygon& outline) {
  std::size_t seen = 0;  // corners in a row that stay
  for (std::size_t i = 0; seen < outline.size() && outline.size() > 3;) {
    const std::size_t n = outline.size();
    const Vec2& before = outline[(i + n - 1) % n];
    const Vec2& after = outline[(i + 1) % n];
    const Vec2 base = after - before;
    const double shorter = std::min((outline[i] - before).norm(), (after - outline[i]).norm());
    if (shorter < kShortEdge && common::cross(outline[i] - before, base) <= kFlat * base.norm()) {
      outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(i));
      i = (i + n - 2) % (n - 1);  // the corner before has another neighbour now
      seen = 0;
    } else {
      i = (i + 1) % n;
      ++seen;
    }
  }
}

/// Diameter 1, centroid at the origin, counter-clockwise.
Polygon normalized(Polygon outline, const std::string& name) {
  if (outline.size() >= 3 && common::area(outline) < 0) std::reverse(outline.begin(), outline.end());
  if (const std::string defect = common::outline_defect(outline); !defect.empty()) {
    throw common::bad_input(fmt::format("{}: {}", name, defect));
  }
  const common::Center center = common::center_of(outline);
  const double diameter = common::diameter(outline);
  for (Vec2& vertex : outline) vertex = center.to(vertex) / diameter;
  leave_out_flat_corners(outline);
  return outline;
}

std::vector<Polygon> draw_shape_types(const common::ShapeOptions& options, common::Random& random) {
  const auto require = [](bool good, const char* key, const std::string& found, const char* expected) {
    if (!good) {
      throw common::bad_input(fmt::format("assembly.shapes.{}: found {}, expected {}", key, found, expected));
    }
  };
  require(options.types >= 1, "types", fmt::format("{}", options.types), "at least 1");
  require(options.corners_min >= 3 && options.corners_min <= options.corners_max && options.corners_max <= 32,
          "corners_min, corners_max", fmt::format("{} and {}", options.corners_min, options.corners_max),
          "3 <= corners_min <= corners_max <= 32");
  require(options.roughness >= 0 && options.roughness <= 0.45, "roughness", fmt::format("{}", options.roughness),
          "a number in [0, 0.45]");
  require(options.aspect > 0 && options.aspect <= 1, "aspect", fmt::format("{}", options.aspect), "a number in (0, 1]");

  std::vector<Polygon> types;
  double spread = random.uniform();
  for (int k = 0; k < options.types; ++k) {
    const int corners = options.corners_min + k % (options.corners_max - options.corners_min + 1);
    spread += kGoldenFraction;
    if (spread >= 1) spread -= 1;
    const double axes = options.aspect + (1 - options.aspect) * spread;
    const double phase = random.uniform(0, kTwoPi);
    Polygon outline;
    for (int i = 0; i < corners; ++i) {
      const double moved = i + options.roughness * random.uniform(-1, 1);
      const common::SinCos at = common::sin_cos(phase + kTwoPi * moved / corners);
      outline.push_back(Vec2(at.cos, axes * at.sin));
    }
    types.push_back(normalized(std::move(outline), fmt::format("generated shape type {}", k)));
  }
  return types;
}

/// True if an edge of `a` has all of `b` on its outer side.
bool has_separating_edge(PolygonView a, PolygonView b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2& start = a[i];
    const Vec2 edge = a[i + 1 < a.size() ? i + 1 : 0] - start;
    if (std::all_of(b.begin(), b.end(), [&](const Vec2& p) { return common::cross(edge, p - start) < 0; })) return true;
  }
  return false;
}

/// Polygons by random trial in a circle around the origin.
class Placement {
 public:
  Placement(double radius, double largest_bound)
      : radius_(radius), cell_(2 * largest_bound), columns_(static_cast<int>(2 * radius / cell_) + 1) {
    cells_.resize(static_cast<std::size_t>(columns_) * columns_);
  }

  /// `outline`: turned, centroid at the origin, within `bound` of it. Where it found room, if it did.
  std::optional<Vec2> place(const Polygon& outline, double bound, common::Random& random) {
    const double reach = radius_ - bound;
    for (int trial = 0; trial < kTrials; ++trial) {
      const double x = random.uniform(-reach, reach);
      const double y = random.uniform(-reach, reach);
      const Vec2 at(x, y);
      if (at.squaredNorm() > reach * reach || !is_free(outline, at, bound)) continue;
      Polygon world = outline;
      for (Vec2& vertex : world) vertex += at;
      cells_[cell_of(at.y()) * columns_ + cell_of(at.x())].push_back(static_cast<int>(placed_.size()));
      placed_.push_back({std::move(world), at, bound});
      return at;
    }
    return std::nullopt;
  }

 private:
  struct Placed {
    Polygon outline;
    Vec2 at;
    double bound;
  };

  int cell_of(double coordinate) const {
    return std::clamp(static_cast<int>((coordinate + radius_) / cell_), 0, columns_ - 1);
  }

  bool is_free(const Polygon& outline, const Vec2& at, double bound) const {
    Polygon world;
    const int column = cell_of(at.x());
    const int row = cell_of(at.y());
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, columns_ - 1); ++r) {
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c) {
        for (const int k : cells_[static_cast<std::size_t>(r) * columns_ + c]) {
          const Placed& other = placed_[static_cast<std::size_t>(k)];
          const double touch = bound + other.bound;
          if ((other.at - at).squaredNorm() > touch * touch) continue;
          if (world.empty()) {
            world = outline;
            for (Vec2& vertex : world) vertex += at;
          }
          if (!has_separating_edge(world, other.outline) && !has_separating_edge(other.outline, world)) return false;
        }
      }
    }
    return true;
  }

  double radius_;
  double cell_;
  int columns_;
  std::vector<std::vector<int>> cells_;
  std::vector<Placed> placed_;
};

/// A particle before it has a place and a number.
struct Draft {
  std::int32_t type = 0;
  double angle = 0;
  Polygon body;  ///< body frame, of its size
  double area = 0;
  double bound = 0;  ///< radius about the centroid
  Vec2 at = Vec2::Zero();
};

/// The drafts' numbers in the order in which Hilbert's curve through the circle of `radius` meets their places.
std::vector<std::size_t> order_in_space(const std::vector<Draft>& drafts, double radius) {
  constexpr int kLevels = 16;
  constexpr double kCells = 1 << kLevels;
  const auto cell = [radius](double coordinate) {
    return static_cast<std::uint32_t>(std::clamp((coordinate / radius + 1) / 2 * kCells, 0.0, kCells - 1));
  };
  std::vector<std::pair<std::uint64_t, std::size_t>> places;
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    places.emplace_back(hilbert_index(cell(drafts[i].at.x()), cell(drafts[i].at.y()), kLevels), i);
  }
  std::sort(places.begin(), places.end());
  std::vector<std::size_t> order;
  for (const auto& [place, i] : places) order.push_back(i);
  return order;
}

void append(Particles& particles, const Draft& draft, double density) {
  const auto id = static_cast<std::int64_t>(particles.size());
  particles.id.push_back(id);
  particles.parent.push_back(-1);
  particles.root.push_back(id);
  particles.generation.push_back(0);
  particles.type.push_back(draft.type);
  particles.position.push_back(draft.at);
  particles.velocity.push_back(Vec2::Zero());
  particles.displacement.push_back(Vec2::Zero());
  particles.angle.push_back(draft.angle);
  particles.angular_velocity.push_back(0);
  particles.mass.push_back(density * draft.area);
  particles.inertia.push_back(density * common::polar_moment(draft.body));
  particles.area.push_back(draft.area);
  particles.boundary.push_back(0);
  particles.vertices.insert(particles.vertices.end(), draft.body.begin(), draft.body.end());
  particles.vertex_offset.push_back(static_cast<std::int64_t>(particles.vertices.size()));
}

}  // namespace

std::vector<Polygon> make_shape_types(const common::ShapeOptions& options, common::Random& random) {
  if (options.source == "generated") return draw_shape_types(options, random);
  std::vector<Polygon> outlines = options.outlines;
  if (outlines.empty()) throw common::bad_input("assembly.shapes.outlines: no outline found, at least one expected");
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    outlines[k] = normalized(std::move(outlines[k]), fmt::format("assembly.shapes.outlines: outline {} (from 0)", k));
  }
  return outlines;
}

Particles generate_assembly(const common::AssemblyOptions& options, double density, std::uint64_t seed) {
  common::Random random(seed);
  const std::vector<Polygon> types = make_shape_types(options.shapes, random);
  std::vector<Draft> drafts(static_cast<std::size_t>(options.particles));
  for (std::size_t i = 0; i < drafts.size(); ++i) {
    Draft& draft = drafts[i];
    draft.type = static_cast<std::int32_t>(random.index(types.size()));
    draft.body = types[static_cast<std::size_t>(draft.type)];
    // One particle in each of equal shares of the counted distribution: a few large ones make much of the mass.
    const double diameter =
        options.grading.empty()
            ? random.uniform(options.diameter_min, options.diameter_max)
            : common::diameter_at(options.grading, (static_cast<double>(i) + random.uniform()) / options.particles);
    draft.angle = random.uniform(0, kTwoPi);
    for (Vec2& vertex : draft.body) vertex *= diameter;
    draft.area = common::area(draft.body);
    draft.bound = common::radius_about(draft.body, Vec2::Zero());
  }

  double solids = 0;
  double largest = 0;
  for (const Draft& draft : drafts) {
    solids += draft.area;
    largest = std::max(largest, draft.bound);
  }
  std::vector<std::size_t> by_size(drafts.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](std::size_t l, std::size_t r) { return drafts[l].bound > drafts[r].bound; });

  for (double radius = std::max(std::sqrt(2 * solids / (kTwoPi * kFirstSolidFraction)), 1.01 * largest);;
       radius *= kGrowth) {
    Placement placement(radius, largest);
    const bool all = std::all_of(by_size.begin(), by_size.end(), [&](std::size_t i) {
      const common::Rotation rotation(drafts[i].angle);
      Polygon turned = drafts[i].body;
      for (Vec2& vertex : turned) vertex = rotation * vertex;
      const std::optional<Vec2> at = placement.place(turned, drafts[i].bound, random);
      if (at) drafts[i].at = *at;
      return at.has_value();
    });
    if (!all) continue;
    Particles particles;
    for (const std::size_t i : order_in_space(drafts, radius)) append(particles, drafts[i], density);
    return particles;
  }
}

}  // namespace dem
