#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "sample_frame.hpp"
#include "xfem/crack_state.hpp"

using common::Vec2;

namespace {

/// A horizontal crack across the edges of a square's mesh at height y, between x = low and x = high.
xfem::Crack crack_across(const xfem::Mesh& mesh, double y, double low, double high) {
  const std::vector<Vec2> line{{low, y}, {high, y}};
  return xfem::place_polyline(mesh, line, {xfem::TipState::active, xfem::TipState::arrested});
}

const common::Polygon kSquare{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};

}  // namespace

TEST_CASE("cracks survive the way into a split and back") {
  const xfem::Mesh mesh = xfem::make_mesh(kSquare, 150);
  const std::vector<xfem::Crack> first{crack_across(mesh, 0.013, -0.4, 0.3), crack_across(mesh, 0.21, -0.2, 0.4)};
  const std::vector<xfem::Crack> second{crack_across(mesh, -0.3, -0.3, 0.3)};
  common::Split split;
  xfem::append_cracks(split, 3, first);
  xfem::append_cracks(split, 8, second);
  const xfem::CrackState state = xfem::stored_cracks(split);
  REQUIRE(state.size() == 2);
  REQUIRE(state.at(3).size() == 2);
  for (int k : {0, 1}) {
    const xfem::Crack& back = state.at(3)[k];
    REQUIRE(back.points.size() == first[k].points.size());
    CHECK(back.tips == first[k].tips);
    for (std::size_t p = 0; p < back.points.size(); ++p) {
      CHECK(back.points[p].edge == first[k].points[p].edge);
      CHECK(back.points[p].fraction == first[k].points[p].fraction);
      CHECK(back.points[p].position == first[k].points[p].position);
    }
  }
}

TEST_CASE("a stored crack is taken as it is on its own mesh and placed anew on another") {
  const xfem::Mesh mesh = xfem::make_mesh(kSquare, 150);
  const xfem::Crack crack = crack_across(mesh, 0.013, -0.4, 0.3);
  REQUIRE(crack.points.size() >= 4);
  const auto same = xfem::crack_on_mesh(mesh, crack);
  REQUIRE(same);
  REQUIRE(same->points.size() == crack.points.size());
  for (std::size_t p = 0; p < crack.points.size(); ++p) CHECK(same->points[p].position == crack.points[p].position);

  const xfem::Mesh finer = xfem::make_mesh(kSquare, 400);
  const auto placed = xfem::crack_on_mesh(finer, crack);
  REQUIRE(placed);
  CHECK(placed->points.size() > crack.points.size());
  for (const xfem::CrackPoint& point : placed->points) {
    const Vec2 on_edge =
        finer.nodes[point.edge[0]] + point.fraction * (finer.nodes[point.edge[1]] - finer.nodes[point.edge[0]]);
    CHECK((on_edge - point.position).norm() < 1e-9);
  }
}

TEST_CASE("a fragment inherits the cracks on its side of the path and clear of it, in its own frame") {
  const auto crack = [](std::vector<Vec2> positions) {
    xfem::Crack made;
    for (const Vec2& p : positions) made.points.push_back({{0, 1}, 0, p});
    return made;
  };
  const std::array<Vec2, 2> path{Vec2{0, -1}, Vec2{0, 1}};  // upward: left is x < 0
  const std::vector<xfem::Crack> cracks{
      crack({{-0.5, 0}, {-0.4, 0.2}}),            // left
      crack({{0.3, 0}, {0.6, 0.2}, {0.7, 0.1}}),  // right
      crack({{-0.2, 0}, {0.2, 0}}),               // across
      crack({{0, -1}, {-0.2, 0}, {0, 1}}),        // the path itself, bulging
      crack({{0.05, 0}, {0.4, 0}}),               // opens into the path
  };
  const auto left = xfem::inherited_cracks(cracks, {3}, path, +1, {-0.5, 0.1}, 0.1);
  REQUIRE(left.size() == 1);
  CHECK((left[0].polyline[1] - Vec2{0.1, 0.1}).norm() < 1e-15);
  const auto right = xfem::inherited_cracks(cracks, {3}, path, -1, {0.5, 0.1}, 0.1);
  REQUIRE(right.size() == 1);
  CHECK(right[0].polyline.size() == 3);
  CHECK((right[0].polyline[0] - Vec2{-0.2, -0.1}).norm() < 1e-15);
  // What the path went through is gone, however far from the straight line it lies.
  CHECK(xfem::inherited_cracks(cracks, {1, 3}, path, -1, {0.5, 0.1}, 0.1).empty());
}

TEST_CASE("a previous split that cannot precede the frame is refused with the reason") {
  const common::Frame frame = sample::frame();
  common::Split split;
  split.config_hash = "abc";
  split.frame = frame.frame - 1;
  CHECK_NOTHROW(xfem::check_previous(split, frame, "abc"));
  const auto message = [&](const common::Split& previous, const std::string& hash) {
    try {
      xfem::check_previous(previous, frame, hash);
    } catch (const common::Error& error) {
      CHECK(error.code() == common::ExitCode::bad_input);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  CHECK_THAT(message(split, "def"), Catch::Contains("made with configuration abc, this one is def"));
  common::Split late = split;
  late.frame = frame.frame;
  CHECK_THAT(message(late, "abc"), Catch::Contains("belongs to frame 7, expected one before frame 7"));
  common::Split unknown = split;
  unknown.cracks.particle = {999};
  CHECK_THAT(message(unknown, "abc"), Catch::Contains("cracked particle 999 is not in frame 7"));
  common::Split unapplied = split;
  unapplied.broken.parent = {5};
  CHECK_THAT(message(unapplied, "abc"), Catch::Contains("broken particle 5 is still in frame 7"));
}
