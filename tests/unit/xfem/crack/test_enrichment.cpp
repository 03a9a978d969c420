#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>

#include "common/geometry/chord_split.hpp"
#include "plates.hpp"
#include "xfem/crack/cracked_solver.hpp"

using namespace xfem;
using plates::kRock;
using plates::plate;
using plates::straight_crack;

namespace {

/// A small rigid motion: translation and linearized rotation.
struct Motion {
  Vec2 translation;
  double rotation;
  Vec2 at(const Vec2& x) const { return translation + rotation * common::perpendicular(x); }
};

/// The two motions on the two sides, as standard and enriched dofs (Eq. 1): u_J is the true displacement of a node,
/// q_J half the jump at the node.
void two_motions(const Mesh& mesh, const Enrichment& enrichment, const Motion& left, const Motion& right,
                 const std::function<bool(const Vec2&)>& is_left, Eigen::VectorXd& u, Eigen::VectorXd& q) {
  u.resize(2 * static_cast<Eigen::Index>(mesh.nodes.size()));
  q.resize(2 * static_cast<Eigen::Index>(enrichment.functions.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    u.segment<2>(2 * i) = (is_left(mesh.nodes[i]) ? left : right).at(mesh.nodes[i]);
  }
  for (std::size_t f = 0; f < enrichment.functions.size(); ++f) {
    const Vec2& x = mesh.nodes[enrichment.functions[f].node];
    q.segment<2>(2 * f) = (left.at(x) - right.at(x)) / 2;
  }
}

/// Largest strain component over all parts of all elements.
double largest_strain(const IntactModel& model, const Enrichment& enrichment, const Eigen::VectorXd& u,
                      const Eigen::VectorXd& q) {
  const Mesh& mesh = model.mesh();
  double largest = 0;
  std::vector<const CutElement*> cut(mesh.triangles.size(), nullptr);
  for (const CutElement& element : enrichment.cut) cut[element.element] = &element;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Eigen::Matrix2d standard = Eigen::Matrix2d::Zero();
    for (int k = 0; k < 3; ++k) {
      standard += u.segment<2>(2 * mesh.triangles[t][k]) * model.gradients()[t].gradient[k].transpose();
    }
    const std::size_t parts = cut[t] != nullptr ? cut[t]->parts.size() : 1;
    for (std::size_t p = 0; p < parts; ++p) {
      Eigen::Matrix2d gradient = standard;
      if (cut[t] != nullptr) {
        for (const CutElement::Term& term : cut[t]->terms) {
          gradient += enrichment.jump(term, cut[t]->parts[p]) * q.segment<2>(2 * term.function) *
                      model.gradients()[t].gradient[term.local].transpose();
        }
      }
      largest = std::max(largest, (gradient + gradient.transpose()).cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("A through cut lets two parts move rigidly without strain, wherever it runs") {
  const Motion left{{0.3, -0.2}, 0.7};
  const Motion right{{-0.1, 0.5}, -0.4};
  for (const double jitter : {0.0, 0.3}) {
    const IntactModel model(plate(2, 1, 10, 5, jitter), kRock);
    for (const double offset : {-0.09, -0.03, -1e-3, 1e-3, 0.02, 0.05, 0.0999}) {
      const Crack crack = straight_crack(model.mesh(), {1.0 + offset, 0}, {1.02 + offset, 1}, true);
      REQUIRE(crack.tips[0] == TipState::at_boundary);
      REQUIRE(crack.tips[1] == TipState::at_boundary);
      const Enrichment enrichment = enrich(model.mesh(), {&crack, 1});
      std::map<int, int> side;
      for (const CrackSegment& segment : enrichment.segments) {
        for (int k = 0; k < 3; ++k) side[model.mesh().triangles[segment.element][k]] = segment.side[k];
      }
      // Every node of a cut element takes part: none was dropped.
      CHECK(enrichment.functions.size() == side.size());
      const auto is_left = [&](const Vec2& x) {
        for (const auto& [node, value] : side) {
          if (model.mesh().nodes[node] == x) return value > 0;
        }
        return x.x() < 1 + offset;
      };
      Eigen::VectorXd u, q;
      two_motions(model.mesh(), enrichment, left, right, is_left, u, q);
      CHECK(largest_strain(model, enrichment, u, q) < 1e-10);
      // Two loose parts: the solver says so instead of solving.
      CrackedSolver solver(model, plates::traction_forces(model.mesh(), {1e6, 0, 0}));
      CHECK_FALSE(solver.solve({&crack, 1}).solved);
    }
  }
}

TEST_CASE("The parts of cut elements fill them, with one crack and with two that cross") {
  const Mesh mesh = plate(2, 1, 8, 4, 0.3);
  std::vector<Crack> cracks{straight_crack(mesh, {0.2, 0.13}, {1.9, 0.83}),
                            straight_crack(mesh, {0.3, 0.9}, {1.7, 0.2})};
  bool crossed = false;
  for (const std::size_t count : {1u, 2u}) {
    const Enrichment enrichment = enrich(mesh, std::span(cracks).first(count));
    for (const CutElement& element : enrichment.cut) {
      double sum = 0;
      for (const ElementPart& part : element.parts) {
        sum += part.area;
        const Polygon corners = outline(mesh, element.element, part);
        CHECK(part.area == Approx(common::area(corners)).epsilon(1e-10));
        CHECK(part.side.size() == element.segments.size());
        // Each part lies on the side that it names.
        const Vec2 middle = common::centroid(corners);
        for (std::size_t slot = 0; slot < element.segments.size(); ++slot) {
          const CrackSegment& segment = enrichment.segments[element.segments[slot]];
          CHECK((common::cross(segment.last.position - segment.first.position, middle - segment.first.position) > 0) ==
                (part.side[slot] > 0));
        }
      }
      CHECK(sum == Approx(mesh.areas[element.element]).epsilon(1e-13));
      crossed = crossed || element.segments.size() == 2;
    }
  }
  CHECK(crossed);
}

TEST_CASE("A crack of one or two elements inside has no effect, one of three opens") {
  const IntactModel model(plate(1, 1, 10, 10), kRock);
  const Crack line = straight_crack(model.mesh(), {0.31, 0.53}, {0.9, 0.55});
  REQUIRE(line.points.size() > 4);
  CrackedSolver solver(model, plates::traction_forces(model.mesh(), {0, -1e6, 0}));
  for (const std::size_t points : {2u, 3u, 4u}) {
    Crack crack = line;
    crack.points.resize(points);
    const CrackedState state = solver.solve({&crack, 1});
    REQUIRE(state.solved);
    CHECK((state.q.size() > 0) == (points > 3));
    double change = 0;
    for (const Stress& s : state.stress) change = std::max(change, std::abs(s.yy + 1e6));
    CHECK((change > 1e4) == (points > 3));
  }
}

TEST_CASE("A crack that starts at the boundary opens its mouth from the first element on") {
  const IntactModel model(plate(1, 1, 10, 10), kRock);
  Crack crack = straight_crack(model.mesh(), {0, 0.53}, {0.5, 0.54}, true);
  crack.points.resize(2);
  CHECK(crack.tips[0] == TipState::at_boundary);
  const Enrichment enrichment = enrich(model.mesh(), {&crack, 1});
  CHECK(enrichment.functions.size() == 1);
}

TEST_CASE("Loads beside a mouth and the inertia relief do the right work on a jump") {
  // Rectangle cut through along x = cut: the virtual work of two rigid motions is that of the loads and of the body
  // force, part by part; the body force's is integrated here over the two rectangles.
  const double cut = 0.87;
  const IntactModel model(plate(2, 1, 8, 4), kRock);
  const Crack crack = straight_crack(model.mesh(), {cut, 0}, {cut, 1}, true);
  const Enrichment enrichment = enrich(model.mesh(), {&crack, 1});
  const Motion left{{0.3, -0.2}, 0.7};
  const Motion right{{-0.1, 0.5}, -0.4};
  const auto is_left = [&](const Vec2& x) { return x.x() < cut; };
  Eigen::VectorXd u, q;
  two_motions(model.mesh(), enrichment, left, right, is_left, u, q);

  for (const double patch : {0.0, 0.07, 0.3}) {
    for (const double place : {0.76, 0.80, 0.86, 0.88, 0.97, 0.2, 1.9}) {
      const std::vector<Load> loads{{{place, 0}, {2e5, 1e6}}, {{0.9, 1}, {-3e5, -4e5}}};
      const double work =
          model.nodal_forces(loads, patch).dot(u) + EdgeLoads(model, loads, patch).forces(enrichment).dot(q);
      double expected = 0;
      Vec2 force = Vec2::Zero();
      double moment = 0;
      const Vec2 center(1, 0.5);
      for (const Load& load : loads) {
        const double x = load.point.x();
        // The load on the left of the cut, with its center of pressure, and the one on the right.
        const double low = x - patch / 2, high = x + patch / 2;
        const double share = patch > 0 ? std::clamp((cut - low) / patch, 0.0, 1.0) : (x < cut ? 1.0 : 0.0);
        const double end_left = std::min(high, cut), start_right = std::max(low, cut);
        expected += share * load.force.dot(left.at({(low + end_left) / 2, load.point.y()}));
        expected += (1 - share) * load.force.dot(right.at({(start_right + high) / 2, load.point.y()}));
        force += load.force;
        moment += common::cross(load.point - center, load.force);
      }
      if (place == 1.9 && patch > 0.2) continue;  // this patch bends round the corner
      if (place == 0.2 && patch > 0.4) continue;
      const double area = 2;
      const double polar = area * (4.0 + 1.0) / 12;
      const auto body = [&](const Vec2& x) -> Vec2 {
        return -force / area - moment / polar * common::perpendicular(x - center);
      };
      // Gauss points of degree 3 in x and y.
      const double g = std::sqrt(1.0 / 3);
      for (const auto& [from, to, motion] : {std::tuple{0.0, cut, left}, std::tuple{cut, 2.0, right}}) {
        for (const double i : {-g, g}) {
          for (const double j : {-g, g}) {
            const Vec2 x((from + to) / 2 + i * (to - from) / 2, 0.5 + j / 2);
            expected += (to - from) / 4 * body(x).dot(motion.at(x));
          }
        }
      }
      CHECK(work == Approx(expected).epsilon(1e-10).margin(1e-5));
    }
  }
}
