#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "common/error.hpp"
#include "common/math/random.hpp"
#include "sample_frame.hpp"
#include "xfem/crack_state.hpp"
#include "xfem/solve_frame.hpp"

using common::ParticleStatus;
using common::Vec2;

namespace {

std::string payload(const common::Split& split) {
  const scratch::Folder directory;
  common::Split copy = split;
  return common::write_split(directory / "split.h5", copy, {}).payload_hash;
}

int count(const common::Split& split, ParticleStatus status) {
  return static_cast<int>(std::count(split.particles.status.begin(), split.particles.status.end(), status));
}

}  // namespace

TEST_CASE("statuses follow from boundary, size and load") {
  const common::Frame frame = sample::frame();
  xfem::FrameSolver solver(sample::scene(), 1);
  const common::Split split = solver.solve(frame, nullptr);
  REQUIRE(split.particles.id == frame.particles.id);
  for (int wall = 0; wall < sample::kWalls; ++wall) {
    CHECK(split.particles.status[wall] == ParticleStatus::not_breakable);
    CHECK(std::isnan(split.particles.min_safety_factor[wall]));
  }
  CHECK(split.particles.status[sample::kSmall] == ParticleStatus::not_breakable);
  CHECK(split.particles.status[sample::kUnloaded] == ParticleStatus::intact);
  CHECK(std::isinf(split.particles.min_safety_factor[sample::kUnloaded]));
  CHECK(split.particles.status[sample::kGentle] == ParticleStatus::screened);
  CHECK(split.particles.min_safety_factor[sample::kGentle] > 10);
  CHECK(count(split, ParticleStatus::refused) == 0);
  CHECK(count(split, ParticleStatus::broken) >= 4);
  CHECK(split.work.screened == count(split, ParticleStatus::screened));
  CHECK(split.work.solved + split.work.screened == 1 + sample::kCrushed);
  CHECK(split.frame == frame.frame);
  CHECK(solver.warnings().empty());
}

TEST_CASE("a frame without contacts leaves every particle unloaded") {
  common::Frame frame = sample::frame();
  frame.contacts = {};
  const common::Split split = xfem::FrameSolver(sample::scene(), 2).solve(frame, nullptr);
  for (std::size_t i = sample::kWalls; i < frame.particles.size(); ++i) {
    if (static_cast<int>(i) == sample::kSmall) continue;
    CHECK(split.particles.status[i] == ParticleStatus::intact);
    CHECK(std::isinf(split.particles.min_safety_factor[i]));
    CHECK(split.particles.mean_stress[i] == std::array<double, 3>{0, 0, 0});
  }
}

TEST_CASE("mean stress is the virial of the contact forces in world axes") {
  const common::Frame frame = sample::frame();
  const common::Split split = xfem::FrameSolver(sample::scene(), 2).solve(frame, nullptr);
  for (std::size_t i = sample::kWalls; i < frame.particles.size(); ++i) {
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t c = 0; c < frame.contacts.size(); ++c) {
      if (frame.contacts.b[c] != frame.particles.id[i]) continue;
      const Vec2 arm = frame.contacts.point[c] - frame.particles.position[i], force = frame.contacts.force[c];
      xx -= force.x() * arm.x();
      yy -= force.y() * arm.y();
      xy -= 0.5 * (force.x() * arm.y() + force.y() * arm.x());
    }
    const double area = common::area(frame.particles.outline(i)), size = std::abs(xx) + std::abs(yy);
    INFO("particle " << i);
    CHECK(std::abs(split.particles.mean_stress[i][0] * area - xx) <= 1e-9 * size);
    CHECK(std::abs(split.particles.mean_stress[i][1] * area - yy) <= 1e-9 * size);
    CHECK(std::abs(split.particles.mean_stress[i][2] * area - xy) <= 1e-9 * size);
  }
}

TEST_CASE("fragments fill their parents, take ids in order and stand left of the path first") {
  const common::Frame frame = sample::frame();
  const common::Split split = xfem::FrameSolver(sample::scene(), 1).solve(frame, nullptr);
  REQUIRE(split.broken.parent.size() >= 4);
  REQUIRE(split.fragments.id.size() == 2 * split.broken.parent.size());
  CHECK(std::is_sorted(split.broken.parent.begin(), split.broken.parent.end()));
  for (std::size_t m = 0; m < split.broken.parent.size(); ++m) {
    const auto parent = static_cast<std::size_t>(split.broken.parent[m]);  // ids are indices here
    const auto& path = split.broken.path[m];
    double sum = 0;
    for (std::size_t f : {2 * m, 2 * m + 1}) {
      CHECK(split.fragments.id[f] == frame.next_id + static_cast<std::int64_t>(f));
      CHECK(split.fragments.parent[f] == split.broken.parent[m]);
      const common::Polygon outline(split.fragments.vertices.begin() + split.fragments.vertex_offset[f],
                                    split.fragments.vertices.begin() + split.fragments.vertex_offset[f + 1]);
      CHECK(common::outline_defect(outline).empty());
      sum += common::area(outline);
      const double side = common::cross(path[1] - path[0], common::centroid(outline) - path[0]);
      CHECK((f == 2 * m ? side > 0 : side < 0));
    }
    const double whole = common::area(frame.particles.outline(parent));
    CHECK(std::abs(sum - whole) <= 1e-12 * whole);
    // The path of a broken particle is no crack of anybody.
    CHECK(std::count(split.cracks.particle.begin(), split.cracks.particle.end(), split.broken.parent[m]) == 0);
  }
  common::Frame foreign = frame;
  foreign.next_id = 0;
  CHECK(xfem::FrameSolver(sample::scene(), 1).solve(foreign, nullptr).fragments.id[0] == frame.particles.id.back() + 1);
}

TEST_CASE("the split is the same for any number of threads, with and without cached models") {
  const common::Frame frame = sample::frame();
  xfem::FrameSolver one(sample::scene(), 1), two(sample::scene(), 2);
  const common::Split first = one.solve(frame, nullptr);
  const std::string expected = payload(first);
  CHECK(payload(two.solve(frame, nullptr)) == expected);
  for (int threads : {3, 4})
    CHECK(payload(xfem::FrameSolver(sample::scene(), threads).solve(frame, nullptr)) == expected);
  CHECK(one.counts().at("models_built") == sample::kCrushed);  // two have the same shape
  CHECK(payload(one.solve(frame, nullptr)) == expected);
  CHECK(one.counts().at("models_built") == 0);

  // The next frame, through a solver that knows the particles and through one that does not.
  const common::Frame next = sample::next_frame(frame, first, 1.05);
  CHECK(payload(one.solve(next, &first)) == payload(xfem::FrameSolver(sample::scene(), 2).solve(next, &first)));
  CHECK(one.counts().at("models_built") == 0);
}

TEST_CASE("cracks persist: they are kept without load and start the next analysis") {
  const common::Frame frame = sample::frame();
  xfem::FrameSolver solver(sample::scene(), 1);
  const common::Split first = solver.solve(frame, nullptr);
  REQUIRE(count(first, ParticleStatus::arrested) >= 1);
  common::Frame next = sample::next_frame(frame, first, 1);
  next.contacts = {};
  const common::Split second = solver.solve(next, &first);
  const xfem::CrackState before = xfem::stored_cracks(first), after = xfem::stored_cracks(second);
  REQUIRE(before.size() == after.size());
  for (const auto& [id, cracks] : before) {
    REQUIRE(after.at(id).size() == cracks.size());
    CHECK(after.at(id)[0].points.size() == cracks[0].points.size());
    const auto i = std::lower_bound(next.particles.id.begin(), next.particles.id.end(), id) - next.particles.id.begin();
    CHECK(second.particles.status[i] == ParticleStatus::arrested);
  }
}

TEST_CASE("a crack beside the path passes to the fragment that holds it, where it was") {
  const common::Frame frame = sample::frame();
  const common::Scene scene = sample::scene();
  const common::Split plain = xfem::FrameSolver(scene, 1).solve(frame, nullptr);
  const auto fragment = [](const common::Split& split, std::size_t f) {
    return common::Polygon(split.fragments.vertices.begin() + split.fragments.vertex_offset[f],
                           split.fragments.vertices.begin() + split.fragments.vertex_offset[f + 1]);
  };
  int handed_down = 0;
  for (std::size_t m = 0; m < plain.broken.parent.size(); ++m) {
    // A short dead crack along the path, in the middle of the left fragment of the plain solution.
    const std::int64_t parent = plain.broken.parent[m];
    const common::Polygon left = fragment(plain, 2 * m);
    if (common::area(left) < 3 * scene.breakage.minimum_area) continue;
    const Vec2 along = 0.3 * (plain.broken.path[m][1] - plain.broken.path[m][0]), middle = common::centroid(left);
    const std::vector<Vec2> line{middle - along, middle + along};
    const xfem::Mesh mesh =
        xfem::make_mesh(frame.particles.outline(static_cast<std::size_t>(parent)), scene.breakage.nodes);
    const xfem::Crack crack = xfem::place_polyline(mesh, line, {xfem::TipState::arrested, xfem::TipState::arrested});
    common::Split previous;
    previous.frame = frame.frame - 1;
    previous.config_hash = plain.config_hash;
    xfem::append_cracks(previous, parent, {crack});

    const common::Split split = xfem::FrameSolver(scene, 1).solve(frame, &previous);
    const xfem::CrackState state = xfem::stored_cracks(split);
    for (std::size_t f = 0; f < split.fragments.id.size(); ++f) {
      const auto found = state.find(split.fragments.id[f]);
      if (found == state.end()) continue;
      ++handed_down;
      REQUIRE(split.fragments.parent[f] == parent);
      REQUIRE(found->second.size() == 1);
      CHECK(found->second[0].tips == crack.tips);
      common::Polygon outline = fragment(split, f);
      const Vec2 origin = common::centroid(outline);
      for (Vec2& v : outline) v -= origin;
      const xfem::Mesh own = xfem::make_mesh(outline, scene.breakage.nodes);
      const auto on_mesh = xfem::crack_on_mesh(own, found->second[0]);
      REQUIRE(on_mesh);
      for (std::size_t p = 0; p < on_mesh->points.size(); ++p) {
        CHECK(on_mesh->points[p].edge == found->second[0].points[p].edge);
        CHECK((on_mesh->points[p].position - found->second[0].points[p].position).norm() < 1e-12);
        // Each placement may move a point by 2 % of its edge, to keep it off the nodes.
        const Vec2 off = on_mesh->points[p].position + origin - line[0];
        CHECK(std::abs(common::cross(along, off)) / along.norm() < 5e-2 * own.size);
      }
    }
  }
  CHECK(handed_down >= 1);
}

TEST_CASE("an unbalanced particle is named in a warning and still analysed, one that carries nothing is not") {
  common::Frame frame = sample::frame();
  REQUIRE(frame.contacts.b[0] == sample::kGentle);
  REQUIRE(frame.contacts.b[2] == sample::kFirstCrushed);
  xfem::FrameSolver solver(sample::scene(), 1);
  frame.contacts.force[0] *= 1.5;
  solver.solve(frame, nullptr);
  CHECK(solver.warnings().empty());
  frame.contacts.force[2] *= 1.5;
  const common::Split split = solver.solve(frame, nullptr);
  REQUIRE(solver.warnings().size() == 1);
  CHECK_THAT(solver.warnings()[0], Catch::Contains("frame 7") && Catch::Contains("of 1 of") &&
                                       Catch::Contains("worst: particle " + std::to_string(sample::kFirstCrushed)));
  CHECK(split.particles.status[sample::kFirstCrushed] != ParticleStatus::refused);
}

TEST_CASE("particles of one shape share a model, whatever their size, place and angle") {
  common::Frame frame = sample::walls();
  const common::Polygon shape = sample::regular(7, 1, 0.8);
  common::Random random(3);
  constexpr int kParticles = 40;
  for (int k = 0; k < kParticles; ++k) {
    common::Polygon outline = shape;
    const double size = random.uniform(0.1, 0.4);
    for (Vec2& vertex : outline) vertex *= size;
    sample::add_pressed(frame, outline, {2.0 * k, 0}, random.uniform(0, 6), {1e6 * size, 0.3 * k, 0.2});
  }
  sample::sort_contacts(frame.contacts);
  xfem::FrameSolver solver(sample::scene(), 2);
  const std::string together = payload(solver.solve(frame, nullptr));
  // Rounding may set a few apart.
  CHECK(solver.counts().at("models_built") <= 4);
  // The same particles with a cache that knows the shape from somewhere else.
  common::Frame other = frame;
  for (Vec2& vertex : other.particles.vertices) vertex *= 1.3;
  for (Vec2& point : other.contacts.point) point *= 1.3;
  xfem::FrameSolver used(sample::scene(), 1);
  used.solve(other, nullptr);
  CHECK(payload(used.solve(frame, nullptr)) == together);
}

TEST_CASE("size, place, orientation and Young's modulus change the result by nothing but their units") {
  const common::Frame frame = sample::frame();
  const common::Split plain = xfem::FrameSolver(sample::scene(), 1).solve(frame, nullptr);
  const double size = GENERATE(1.0, 0.37, 11.0);
  const common::Rotation turn(GENERATE(0.0, 2.3));
  const Vec2 shift(GENERATE(0.0, 17.0), 3);
  const bool own_frame_turned = GENERATE(false, true);  // or the world around it
  common::Frame moved = frame;
  common::Scene scene = sample::scene();
  scene.material.young_modulus *= 0.1;
  scene.breakage.minimum_area *= size * size;
  for (Vec2& vertex : moved.particles.vertices) vertex *= size;
  if (own_frame_turned)
    for (Vec2& vertex : moved.particles.vertices) vertex = turn * vertex;
  for (std::size_t i = 0; i < moved.particles.size(); ++i) {
    moved.particles.position[i] = shift + size * (turn * moved.particles.position[i]);
    if (!own_frame_turned) {
      const double angle = std::atan2(turn.sin, turn.cos);
      moved.particles.angle[i] += angle;
    }
  }
  for (std::size_t c = 0; c < moved.contacts.size(); ++c) {
    moved.contacts.point[c] = shift + size * (turn * moved.contacts.point[c]);
    moved.contacts.force[c] = size * (turn * moved.contacts.force[c]);
  }
  const common::Split split = xfem::FrameSolver(scene, 2).solve(moved, nullptr);
  CHECK(split.particles.status == plain.particles.status);
  CHECK(split.particles.failure_mode == plain.particles.failure_mode);
  for (std::size_t i = 0; i < frame.particles.size(); ++i) {
    INFO("particle " << i);
    const double factor = plain.particles.min_safety_factor[i];
    // The bound of a screened particle is lower by a margin that depends on how its loads fall on the mesh's nodes.
    const double tolerance = plain.particles.status[i] == ParticleStatus::screened ? 1e-3 : 1e-9;
    if (std::isfinite(factor)) CHECK(std::abs(split.particles.min_safety_factor[i] - factor) <= tolerance * factor);
    const auto& s = plain.particles.mean_stress[i];
    const double c = turn.cos, n = turn.sin, scale = std::abs(s[0]) + std::abs(s[1]) + std::abs(s[2]);
    const auto& t = split.particles.mean_stress[i];
    CHECK(std::abs(t[0] - (c * c * s[0] + n * n * s[1] - 2 * c * n * s[2])) <= 1e-9 * scale);
    CHECK(std::abs(t[2] - (c * n * (s[0] - s[1]) + (c * c - n * n) * s[2])) <= 1e-9 * scale);
  }
  REQUIRE(split.fragments.vertices.size() == plain.fragments.vertices.size());
  for (std::size_t v = 0; v < split.fragments.vertices.size(); ++v) {
    const Vec2 expected = own_frame_turned ? Vec2(turn * plain.fragments.vertices[v]) : plain.fragments.vertices[v];
    CHECK((split.fragments.vertices[v] - size * expected).norm() <= 1e-9 * size);
  }
}

TEST_CASE("a particle under a force that is not finite is refused, the others are not touched by it") {
  const common::Frame frame = sample::frame();
  const common::Split plain = xfem::FrameSolver(sample::scene(), 1).solve(frame, nullptr);
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300, 1.7e308}) {
    common::Frame broken = frame;
    REQUIRE(frame.contacts.b[2] == sample::kFirstCrushed);
    broken.contacts.force[2].x() = bad;
    const common::Split split = xfem::FrameSolver(sample::scene(), 1).solve(broken, nullptr);
    for (std::size_t i = 0; i < frame.particles.size(); ++i) {
      if (i == sample::kFirstCrushed || i < sample::kWalls) continue;
      CHECK(split.particles.status[i] == plain.particles.status[i]);
    }
    for (const auto& stress : split.particles.mean_stress)
      for (const double component : stress) CHECK(std::isfinite(component));
    if (std::abs(bad) < 1e308) continue;
    CHECK(split.particles.status[sample::kFirstCrushed] == ParticleStatus::refused);
    REQUIRE(split.refusals.particle == std::vector<std::int64_t>{sample::kFirstCrushed});
    CHECK_THAT(split.refusals.reason[0], Catch::Contains("not finite"));
    payload(split);  // it can be written
  }
}

TEST_CASE("A frame whose ids leave none for fragments is refused") {
  for (const bool by_next_id : {true, false}) {
    common::Frame frame = sample::frame();
    (by_next_id ? frame.next_id : frame.particles.id.back()) = std::numeric_limits<std::int64_t>::max() - 5;
    xfem::FrameSolver solver(sample::scene(), 1);
    CHECK_THROWS_WITH(solver.solve(frame, nullptr), Catch::Contains("leave none for fragments"));
  }
}
