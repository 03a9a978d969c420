// Oracles: the definition of each property (diameter, area, no overlap by common::overlap).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <functional>

#include "common/error.hpp"
#include "common/geometry/overlap.hpp"
#include "dem/stages/generate.hpp"

using common::Polygon;
using common::Vec2;

namespace {

common::AssemblyOptions assembly(int particles) {
  common::AssemblyOptions options;
  options.particles = particles;
  return options;
}

Polygon world(const dem::Particles& particles, std::size_t i) {
  Polygon outline;
  const common::Rotation turn(particles.angle[i]);
  for (const Vec2& v : particles.outline(i)) outline.push_back(particles.position[i] + turn * v);
  return outline;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const common::Error& error) {
    CHECK(error.code() == common::ExitCode::bad_input);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("generated shape types have the wanted corners, diameter 1 and their centroid at the origin") {
  common::ShapeOptions options;
  double ratio = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    common::Random random(seed);
    const auto types = dem::make_shape_types(options, random);
    REQUIRE(types.size() == 12);
    for (std::size_t k = 0; k < types.size(); ++k) {
      CHECK(types[k].size() == 5 + k % 4);
      CHECK(common::outline_defect(types[k]).empty());
      CHECK(common::diameter(types[k]) == Approx(1).epsilon(1e-14));
      CHECK(common::centroid(types[k]).norm() < 1e-14);
      ratio += common::area(types[k]) / (3.141592653589793 / 4);
      ++count;
    }
  }
  CHECK(ratio / count == Approx(0.70).margin(0.02));
}

TEST_CASE("without roughness and elongation the types are regular polygons") {
  common::ShapeOptions options;
  options.roughness = 0;
  options.aspect = 1;
  options.corners_min = options.corners_max = 6;
  options.types = 1;
  common::Random random(1);
  const auto types = dem::make_shape_types(options, random);
  CHECK(common::area(types[0]) == Approx(6 * std::sqrt(3.0) / 4 / 4));  // hexagon of side 1/2
}

TEST_CASE("an assembly is without overlap, fills half of its circle and has the diameters asked for") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto particles = dem::generate_assembly(assembly(300), 2500, seed);
    REQUIRE(particles.size() == 300);
    double solids = 0, reach = 0, least = 1, most = 0, mean = 0;
    std::vector<Polygon> outlines;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      outlines.push_back(world(particles, i));
      const double diameter = common::diameter(outlines[i]);
      least = std::min(least, diameter);
      most = std::max(most, diameter);
      mean += diameter / 300;
      solids += particles.area[i];
      reach = std::max(reach, common::radius_about(outlines[i], Vec2::Zero()));
      CHECK(particles.area[i] == Approx(common::area(outlines[i])).epsilon(1e-13));
      CHECK(particles.mass[i] == 2500 * particles.area[i]);
      CHECK(particles.inertia[i] == Approx(2500 * common::polar_moment(outlines[i])).epsilon(1e-12));
      CHECK(particles.id[i] == static_cast<std::int64_t>(i));
    }
    CHECK(least >= 0.37 * (1 - 1e-12));
    CHECK(most <= 0.57 * (1 + 1e-12));
    CHECK(mean == Approx(0.47).margin(0.012));  // 3.5 standard errors of a uniform mean
    CHECK(solids / (3.141592653589793 * reach * reach) > 0.45);
    double overlap = 0;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) overlap += common::overlap(outlines[i], outlines[j]).area;
    }
    CHECK(overlap == 0);
  }
}

TEST_CASE("an assembly is a function of its seed") {
  const auto same = [](const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec2)) == 0;
  };
  const auto first = dem::generate_assembly(assembly(100), 2500, 5);
  const auto again = dem::generate_assembly(assembly(100), 2500, 5);
  const auto other = dem::generate_assembly(assembly(100), 2500, 6);
  CHECK(same(first.position, again.position));
  CHECK(same(first.vertices, again.vertices));
  CHECK(first.angle == again.angle);
  CHECK_FALSE(same(first.position, other.position));
}

TEST_CASE("particles that are near in space are near in memory") {
  const auto particles = dem::generate_assembly(assembly(2000), 2500, 4);
  double apart = 0;
  int pairs = 0, close = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((particles.position[i] - particles.position[j]).norm() > 0.6) continue;
      apart += static_cast<double>(i - j);
      close += i - j <= 8;
      ++pairs;
    }
  }
  REQUIRE(pairs > 2000);
  // Numbers at random would be n / 3 = 667 apart and 1 % within 8; row by row, 28 apart but only 40 % within 8.
  CHECK(apart / pairs < 60);
  CHECK(close > 0.65 * pairs);
}

TEST_CASE("one particle, equal sizes and sizes of 10 to 1 can be placed") {
  CHECK(dem::generate_assembly(assembly(1), 2500, 1).size() == 1);
  auto options = assembly(200);
  options.diameter_min = options.diameter_max = 0.5;
  CHECK(dem::generate_assembly(options, 2500, 1).size() == 200);
  options.diameter_min = 0.05;
  CHECK(dem::generate_assembly(options, 2500, 1).size() == 200);
}

TEST_CASE("the sizes of an assembly follow its grading curve") {
  // Smooth, five times from end to end; with a gap between two ranges; two sizes only.
  const std::vector<common::Grading> curves{{{0.1, 0}, {0.2, 0.25}, {0.3, 0.65}, {0.5, 1}},
                                            {{0.2, 0}, {0.25, 0.4}, {0.5, 0.4}, {0.6, 1}},
                                            {{0.2, 0}, {0.2, 0.3}, {0.5, 0.3}, {0.5, 1}}};
  const auto wanted = [](const common::Grading& curve, double d) {
    double passing = 0;
    for (std::size_t k = 1; k < curve.size(); ++k) {
      const auto& [from, below] = curve[k - 1];
      const auto& [to, above] = curve[k];
      if (d >= to) passing = above;
      if (d > from && d < to) passing = below + (above - below) * (d - from) / (to - from);
    }
    return passing;
  };
  for (const common::Grading& curve : curves) {
    auto options = assembly(1500);
    options.grading = curve;
    for (const std::uint64_t seed : {1u, 2u}) {
      const auto particles = dem::generate_assembly(options, 2500, seed);
      double all = 0;
      for (const double area : particles.area) all += area;
      for (int step = 0; step <= 60; ++step) {
        const double d = 0.1 + 0.01 * step + 0.001;  // off the two sizes
        double finer = 0;
        for (std::size_t i = 0; i < particles.size(); ++i) {
          if (common::diameter(particles.outline(i)) <= d) finer += particles.area[i];
        }
        // Areas of the shapes scatter about d^2; the sizes alone would give 0.004.
        CHECK(finer / all == Approx(wanted(curve, d)).margin(0.02));
      }
    }
  }
}

TEST_CASE("given outlines are scaled, centred and turned counter-clockwise") {
  common::ShapeOptions options;
  options.source = "outlines";
  options.outlines = {{Vec2(7, 0), Vec2(9, 0), Vec2(9, 2), Vec2(7, 2)}, {Vec2(0, 0), Vec2(0, 1), Vec2(1, 0)}};
  common::Random random(1);
  const auto types = dem::make_shape_types(options, random);
  REQUIRE(types.size() == 2);
  CHECK(common::area(types[0]) == Approx(0.5));
  CHECK(common::area(types[1]) == Approx(0.25));
  for (const Polygon& type : types) CHECK(common::centroid(type).norm() < 1e-15);
}

TEST_CASE("given outlines in coordinates of a survey are centred to their own rounding, not to that of the place") {
  // Corners on a grid of 2^-20 m, the ones at 10^7 m the same to the last bit.
  const Polygon near{Vec2(0.625, 0), Vec2(1.375, 0.25), Vec2(0.875, 1.125), Vec2(0x1p-20, 0.5)};
  Polygon far = near;
  for (Vec2& vertex : far) vertex += Vec2(450123, 9876543);
  common::ShapeOptions options;
  options.source = "outlines";
  options.outlines = {near, far};
  common::Random random(1);
  const auto types = dem::make_shape_types(options, random);
  CHECK(common::centroid(types[1]).norm() < 1e-15);
  for (std::size_t i = 0; i < near.size(); ++i) CHECK((types[1][i] - types[0][i]).norm() < 1e-15);
}

TEST_CASE("corners of given outlines that are straight beside a short edge are left out, no others") {
  const Polygon square{Vec2(0, 0), Vec2(3, 0), Vec2(3, 3), Vec2(0, 3)};
  const Polygon twice{Vec2(0, 0), Vec2(1, 0), Vec2(1 + 1e-8, 0), Vec2(3 - 1e-9, 0),
                      Vec2(3, 0), Vec2(3, 3), Vec2(0, 3),        Vec2(0, 1e-7)};
  // A corner of 90 degrees and one of 1e-3 rad beside short edges, and a straight one between long edges.
  const Polygon corners{Vec2(0, 0),        Vec2(1, 0),        Vec2(3 - 1e-6, 0), Vec2(3, 1e-6),
                        Vec2(3, 3 - 1e-6), Vec2(3 - 1e-9, 3), Vec2(0, 3)};
  common::ShapeOptions options;
  options.source = "outlines";
  options.outlines = {square, twice, corners};
  common::Random random(1);
  const auto types = dem::make_shape_types(options, random);
  CHECK(types[2].size() == corners.size());
  // Of the points at 1 one is left, which is straight between long edges.
  REQUIRE(types[1].size() == 5);
  CHECK(common::area(types[1]) == Approx(common::area(types[0])).epsilon(1e-14));
}

TEST_CASE("bad shape options are refused by name") {
  common::ShapeOptions options;
  options.source = "outlines";
  options.outlines = {{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)}, {Vec2(0, 0), Vec2(2, 0), Vec2(0.1, 0.1), Vec2(0, 2)}};
  const auto make = [&] {
    common::Random random(1);
    dem::make_shape_types(options, random);
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(message_of(make), Contains("outline 1") && Contains("convex"));
  options.outlines = {};
  CHECK_THAT(message_of(make), Contains("no outline"));
  options.source = "generated";
  options.corners_min = 9;
  CHECK_THAT(message_of(make), Contains("corners_min"));
  options.corners_min = 5;
  options.roughness = 0.5;
  CHECK_THAT(message_of(make), Contains("roughness") && Contains("0.45"));
}
