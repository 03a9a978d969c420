// Hard states of one particle: tips on nodes, cracks around a node, loads out of balance, cracks that live long.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "common/io/split.hpp"
#include "tests/robustness/xfem/full_system.hpp"
#include "tests/robustness/xfem/growth_walk.hpp"
#include "tests/unit/xfem/crack/plates.hpp"
#include "tests/unit/xfem/outlines.hpp"
#include "tests/unit/xfem/sample_frame.hpp"
#include "xfem/crack_state.hpp"

using namespace xfem;
using common::ParticleStatus;

namespace {

constexpr int kCells = 8;
const common::Polygon kPlate{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const std::vector<Load> kPull{{{0.4, 0}, {0, -1e6}}, {{0.6, 1}, {0, 1e6}}};

int node(int i, int j) {
  return j * (kCells + 1) + i;
}

CrackPoint on_edge(const Mesh& mesh, int a, int b, double fraction) {
  return {{a, b}, fraction, mesh.nodes[a] + fraction * (mesh.nodes[b] - mesh.nodes[a])};
}

double largest_opening(const IntactModel& model, const CrackedState& state) {
  double largest = 0;
  for (const FaceSegment& face : face_segments(model.mesh(), model.gradients(), state.enrichment)) {
    largest = std::max(largest, opening(face, state.q));
  }
  return largest;
}

/// Solves under kPull and checks that nothing is left unbalanced.
CrackedState solved(const IntactModel& model, const Crack& crack) {
  REQUIRE(crack_defect(model.mesh(), crack).empty());
  const CrackedState state = CrackedSolver(model, kPull).solve({&crack, 1});
  REQUIRE(state.solved);
  const growth_walks::Residual residual = growth_walks::residual_of(model, kPull, 0, kPlate, state);
  CHECK(residual.is_finite);
  CHECK(residual.scaled < 1e-13);
  CHECK(residual.virial < 1e-14);
  return state;
}

/// Relative L2 norm of the difference of two stress fields.
double distance(const Mesh& mesh, const std::vector<Stress>& one, const std::vector<Stress>& other) {
  double difference = 0, size = 0;
  for (std::size_t t = 0; t < one.size(); ++t) {
    const auto square = [](double xx, double yy, double xy) { return xx * xx + yy * yy + 2 * xy * xy; };
    difference += mesh.areas[t] * square(one[t].xx - other[t].xx, one[t].yy - other[t].yy, one[t].xy - other[t].xy);
    size += mesh.areas[t] * square(other[t].xx, other[t].yy, other[t].xy);
  }
  return std::sqrt(difference / size);
}

/// True if the points of `old` stand in `now`, one after another: it grew at its ends or stayed.
bool lives_on(const Crack& old, const Crack& now) {
  const auto same = [](const CrackPoint& a, const CrackPoint& b) {
    return a.edge == b.edge && a.fraction == b.fraction && a.position == b.position;
  };
  return std::search(now.points.begin(), now.points.end(), old.points.begin(), old.points.end(), same) !=
         now.points.end();
}

}  // namespace

TEST_CASE("A tip on a node is solved, with the opening of a tip beside it") {
  const IntactModel model(plates::plate(1, 1, kCells, kCells), plates::kRock);
  const Mesh& mesh = model.mesh();
  const auto opening_with_tip = [&](double fraction) {
    Crack crack;
    for (int i = 2; i <= 5; ++i) {
      crack.points.push_back(on_edge(mesh, node(i, 3), node(i, 4), 0.45));
      crack.points.push_back(on_edge(mesh, node(i, 3), node(i + 1, 4), 0.45));
    }
    crack.points.push_back(on_edge(mesh, node(6, 3), node(6, 4), fraction));
    const CrackedState state = solved(model, crack);
    CHECK(state.closed_segments == 0);
    return largest_opening(model, state);
  };
  const double middle = opening_with_tip(0.45), beside = opening_with_tip(0.02);
  CHECK(std::abs(beside / middle - 1) < 0.05);
  for (const double fraction : {1e-28, 1e-16, 1e-9, 1e-4, 1 - 1e-4, 1 - 1e-9, 1 - 0x1p-53}) {
    INFO("tip at " << fraction);
    CHECK(std::abs(opening_with_tip(fraction) / middle - 1) < 0.05);
  }
}

TEST_CASE("A crack around a node, through all elements of its fan but one, is solved at every distance from it") {
  const IntactModel model(plates::plate(1, 1, kCells, kCells), plates::kRock);
  const Mesh& mesh = model.mesh();
  const int center = node(4, 4);
  const int spokes[] = {node(5, 4), node(5, 5), node(4, 5), node(3, 4), node(3, 3), node(4, 3)};
  const std::vector<Stress> intact = model.stresses(CrackedSolver(model, kPull).intact_displacement());
  for (const double fraction : {1e-28, 1e-16, 1e-9, 1e-4, 0.02, 0.3, 0.7}) {
    INFO("fraction " << fraction);
    Crack crack;
    for (const int spoke : spokes) crack.points.push_back(on_edge(mesh, center, spoke, fraction));
    const CrackedState state = solved(model, crack);
    // Whatever is cut off is as small as that; from 0.02 on, where production places it, it slides or opens.
    const double change = distance(mesh, state.stress, intact);
    CHECK(change < 10 * fraction + 1e-12);
    CHECK((change > 1e-6) == (fraction >= 0.02));
  }
}

TEST_CASE("A crack beside an edge that a load peels open settles, however many faces it has") {
  // Its faces open one after another, from the end: more than 100 solves for 53 of them.
  constexpr double kHeight = 0.2;
  const common::Polygon strip{{0, 0}, {1, 0}, {1, kHeight}, {0, kHeight}};
  const double depth = GENERATE(0.003, 0.01);
  const int nodes = GENERATE(75, 150, 300);
  const IntactModel model(make_mesh(strip, nodes), plates::kRock);
  const std::vector<Vec2> line{{0, depth}, {0.9, depth}};
  const Crack crack = place_polyline(model.mesh(), line, {TipState::at_boundary, TipState::active});
  REQUIRE(crack_defect(model.mesh(), crack).empty());
  const std::vector<std::vector<Load>> cases{
      {{{0.02, 0}, {0, 1e4}}, {{0.5, kHeight}, {0, -1e4}}},
      {{{0, depth / 2}, {1e4, 0}}, {{1, kHeight / 2}, {-1e4, 0}}},
      {{{0.1, 0}, {1e4, -1e2}}, {{1, kHeight / 2}, {-1e4, 0}}},
      {{{1, kHeight / 2}, {1e4, 3e3}}},
      {{{0, kHeight}, {1e4, 0}}, {{1, kHeight}, {3e3, -2e4}}},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    INFO(nodes << " nodes, crack at " << depth << ", loads " << i);
    const CrackedState state = CrackedSolver(model, cases[i]).solve({&crack, 1});
    REQUIRE(state.solved);
    REQUIRE(state.settled);
    // Faces that were left closed although they pull would be forces on open faces here.
    const growth_walks::Residual residual = growth_walks::residual_of(model, cases[i], 0, strip, state);
    CHECK(residual.scaled < growth_walks::kResidualLimit);
  }
}

TEST_CASE("Faces that only just touch settle: loads between two sets, to the last digit") {
  // Whether such a face is closed or open is rounding, and neither set need agree with its own solution.
  constexpr double kHeight = 0.2;
  const common::Polygon strip{{0, 0}, {1, 0}, {1, kHeight}, {0, kHeight}};
  const IntactModel model(make_mesh(strip, 75), plates::kRock);
  const std::vector<Vec2> line{{0, 0.06}, {0.7, 0.11}};
  const Crack crack = place_polyline(model.mesh(), line, {TipState::at_boundary, TipState::active});
  REQUIRE(crack_defect(model.mesh(), crack).empty());
  common::Random random(5);
  int sets = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Load> low, high;
    for (int k = 0; k < 4; ++k) {
      const Vec2 at(random.uniform(), k % 2 == 0 ? 0 : kHeight);
      low.push_back({at, 1e5 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1))});
      high.push_back({at, 1e5 * Vec2(random.uniform(-1, 1), random.uniform(-1, 1))});
    }
    const auto between = [&](double share) {
      std::vector<Load> loads = low;
      for (std::size_t k = 0; k < loads.size(); ++k) {
        loads[k].force = (1 - share) * low[k].force + share * high[k].force;
      }
      const CrackedState state = CrackedSolver(model, loads).solve({&crack, 1});
      INFO("trial " << trial << " at " << share);
      REQUIRE(state.solved);
      REQUIRE(state.settled);
      CHECK(growth_walks::residual_of(model, loads, 0, strip, state).scaled < growth_walks::kResidualLimit);
      return state.closed_segments;
    };
    double from = 0, to = 1;
    const int closed = between(from);
    if (between(to) == closed) continue;
    ++sets;
    for (int halving = 0; halving < 54; ++halving) {
      const double middle = (from + to) / 2;
      (between(middle) == closed ? from : to) = middle;
    }
  }
  CHECK(sets > 100);
}

TEST_CASE("Loads out of balance by 1 to 22 % change stress and load factor in proportion to what is added") {
  // A force too much at one contact of a balanced particle, carried by inertia. By superposition the change is
  // proportional to that force; its size is what an analysis of a particle not yet at rest is wrong by.
  common::Random random(21);
  const HoekBrown rock{150e6, 25};
  constexpr double kShares[] = {0.01, 0.02, 0.05, 0.1, 0.22};
  double sum[5] = {}, worst[5] = {}, worst_factor[5] = {};
  constexpr int kParticles = 30;
  for (int k = 0; k < kParticles; ++k) {
    const common::Polygon outline = test_outlines::random_outline(random, random.uniform(0.6, 1));
    const IntactModel model(make_mesh(outline, 150), plates::kRock);
    const StressAverage average(model.mesh(), 0.1 * common::equivalent_diameter(common::area(outline)));
    std::vector<Load> loads;
    for (int pair = 0; pair < 2 + k % 2; ++pair) {
      const double angle = random.uniform(0, 6.28);
      const Vec2 direction(std::cos(angle), std::sin(angle));
      const common::Vec2 center = common::centroid(outline);
      common::Polygon about = outline;
      for (Vec2& vertex : about) vertex -= center;
      const double force = random.uniform(1e6, 2e6);
      loads.push_back({center + sample::exit_point(about, direction), -force * direction});
      loads.push_back({center + sample::exit_point(about, -direction), force * direction});
    }
    double carried = 0;
    for (const Load& load : loads) carried += load.force.norm();
    REQUIRE(IntactModel::unbalance(loads) < 1e-14);
    const auto field = [&](const std::vector<Load>& forces) {
      return model.stresses(model.solve(model.nodal_forces(forces)));
    };
    const auto factor = [&](const std::vector<Stress>& stress) {
      double least = std::numeric_limits<double>::infinity();
      for (const Stress& s : average(stress)) {
        const PrincipalStress p = principal(s);
        least = std::min(least, rock.load_factor(p.s1, p.s3));
      }
      return least;
    };
    const std::vector<Stress> balanced = field(loads);
    double per_force = 0;
    for (int u = 0; u < 5; ++u) {
      const double extra = kShares[u] / (1 - kShares[u]) * carried;
      std::vector<Load> pushed = loads;
      pushed[0].force *= 1 + extra / pushed[0].force.norm();
      CHECK(IntactModel::unbalance(pushed) == Approx(kShares[u]).epsilon(1e-12));
      const std::vector<Stress> stress = field(pushed);
      const double error = distance(model.mesh(), stress, balanced);
      if (u == 0) per_force = error / extra;
      CHECK(error == Approx(per_force * extra).epsilon(1e-9));
      sum[u] += error;
      worst[u] = std::max(worst[u], error);
      // 1 / factor is a gauge of the stress: of a sum it is at most the sum of both.
      const std::vector<Load> alone{{loads[0].point, extra * loads[0].force.normalized()}};
      CHECK(1 / factor(stress) <= (1 / factor(balanced) + 1 / factor(field(alone))) * (1 + 1e-9));
      worst_factor[u] = std::max(worst_factor[u], std::abs(factor(stress) / factor(balanced) - 1));
    }
  }
  for (int u = 0; u < 5; ++u) {
    INFO(100 * kShares[u] << " % out of balance: stress off by " << 100 * sum[u] / kParticles << " % (mean), "
                          << 100 * worst[u] << " % (worst), load factor by " << 100 * worst_factor[u] << " % (worst)");
    const double added = kShares[u] / (1 - kShares[u]);
    CHECK(sum[u] / kParticles < 2.5 * added);
    CHECK(worst[u] < 3.5 * added);
    CHECK(worst_factor[u] < 8 * added);
  }
}

TEST_CASE("A crack that rests lives through 50 frames of the executable, loaded and not, to the last bit") {
  const scratch::Folder directory;
  const auto at = [&](const std::string& name) { return (directory / name).string(); };
  std::ofstream(directory / "case.yaml") << common::to_yaml(sample::scene());
  common::Frame frame = sample::frame();
  CrackState before;
  int compared = 0, grown = 0;
  std::string previous;
  for (int k = 0; k < 50; ++k) {
    // Full, none, half, reversed (what was closed opens), full again: only the first frame starts most of the cracks.
    constexpr double kShares[] = {1, 0, 0.5, -0.1, 1};
    common::Frame loaded = frame;
    for (common::Vec2& force : loaded.contacts.force) force *= kShares[k % 5];
    for (double& force : loaded.contacts.normal_force) force *= std::abs(kShares[k % 5]);
    const std::string split = at("split" + std::to_string(k) + ".h5");
    common::write_frame(directory / "frame.h5", loaded, {});
    const std::string command = std::string(ROCKBREAK_BINARY_DIR) + "/xfem solve " + at("frame.h5") + " --config " +
                                at("case.yaml") + previous + " --out " + split + " 2>" + at("stderr");
    REQUIRE(std::system(command.c_str()) == 0);
    const common::Split answer = common::read_split(split);
    const CrackState now = stored_cracks(answer);
    for (const auto& [id, cracks] : before) {
      const auto i = std::lower_bound(frame.particles.id.begin(), frame.particles.id.end(), id);
      const ParticleStatus status = answer.particles.status[i - frame.particles.id.begin()];
      INFO("frame " << k << ", particle " << id << ", status " << static_cast<int>(status));
      if (status == ParticleStatus::broken) continue;
      REQUIRE(status == ParticleStatus::arrested);
      REQUIRE(now.contains(id));
      REQUIRE(now.at(id).size() >= cracks.size());
      for (std::size_t c = 0; c < cracks.size(); ++c) {
        CHECK(lives_on(cracks[c], now.at(id)[c]));
        grown += now.at(id)[c].points.size() > cracks[c].points.size();
        ++compared;
      }
    }
    before = now;
    previous = " --previous " + split;
    frame = sample::next_frame(frame, answer, 1);
  }
  INFO(compared << " cracks compared, " << grown << " of them grown");
  CHECK(compared > 49);
}
