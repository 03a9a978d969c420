// The evidence on the normal contact laws, as one Markdown table (dem/README.md):
//   build/bench/tests/laws [COLLISIONS [CUTS]]
// Whole bodies are those of the generator, fragments what a random chord cuts off them. Cost: overlap and law of the
// contacts of a prepared sample at 2 MPa, the best of many rounds, over that of the area law.
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "pile.hpp"
#include "tests/physics/dem/loaded_pile.hpp"
#include "tests/physics/dem/random_contacts.hpp"

namespace {

using common::ContactLaw;

constexpr std::array kLaws = {ContactLaw::mean_depth, ContactLaw::area, ContactLaw::potential, ContactLaw::foundation};

struct Distribution {
  std::vector<double> values;
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
  double quantile(double q) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  }
};

std::string show_errors(Distribution& d) {
  if (d.values.empty()) return "-";
  return fmt::format("{:.1e} / {:.1e} / {:.1e} ({})", d.mean(), d.quantile(0.99), d.quantile(1), d.values.size());
}

struct Row {
  std::string title;
  std::array<std::string, kLaws.size()> cells;
};

void add_collisions(std::vector<Row>& rows, contacts::Bodies bodies, int starts) {
  constexpr std::array kDepths = {1e-3, 2e-3, 5e-3, 1e-2, 2e-2};
  std::array<std::array<Distribution, kDepths.size() - 1>, kLaws.size()> errors;
  for (int k = 0; k < starts; ++k) {
    const auto start = contacts::approach(bodies, 1000 + k);
    if (!start) continue;
    for (std::size_t law = 0; law < kLaws.size(); ++law) {
      common::Scene scene = piles::scene_of(kLaws[law]);
      scene.effects = {false, false, false, false};
      scene.time_step.safety = 0.02;
      const auto collision = contacts::collide(scene, *start);
      if (!collision) continue;
      for (std::size_t i = 0; i + 1 < kDepths.size(); ++i) {
        if (collision->depth < kDepths[i] || collision->depth >= kDepths[i + 1]) continue;
        errors[law][i].values.push_back(std::abs(collision->error));
      }
    }
  }
  for (std::size_t i = 0; i + 1 < kDepths.size(); ++i) {
    Row row{fmt::format("collision of {}, {:.1f} to {:.1f} % deep: energy error, mean / 99 % / max (number)",
                        bodies == contacts::Bodies::whole ? "whole bodies" : "fragments", 100 * kDepths[i],
                        100 * kDepths[i + 1]),
            {}};
    for (std::size_t law = 0; law < kLaws.size(); ++law) row.cells[law] = show_errors(errors[law][i]);
    rows.push_back(row);
  }
}

void add_cuts(std::vector<Row>& rows, int cuts) {
  std::array<std::array<Distribution, kLaws.size()>, 3> d;
  common::Random random(17);
  const dem::ContactConstants constants{1, 1, 0.47};
  for (int k = 0; k < cuts; ++k) {
    const contacts::CutContact cut = contacts::cut_contact(random);
    const std::array forces = {contacts::forces_of<dem::MeanDepthLaw>(cut, constants),
                               contacts::forces_of<dem::AreaLaw>(cut, constants),
                               contacts::forces_of<dem::PotentialLaw>(cut, constants),
                               contacts::forces_of<dem::FoundationLaw>(cut, constants)};
    for (std::size_t law = 0; law < kLaws.size(); ++law) {
      d[0][law].values.push_back(forces[law].sum);
      d[1][law].values.push_back(forces[law].change);
      d[2][law].values.push_back(forces[law].energy);
    }
  }
  const std::array titles = {"chord through a contact: sum of the forces, after / before, mean (1 %, 99 %)",
                             "the same: change of the resultant / force before", "the same: energy, after / before"};
  for (std::size_t i = 0; i < d.size(); ++i) {
    Row row{titles[i], {}};
    for (std::size_t law = 0; law < kLaws.size(); ++law) {
      row.cells[law] =
          fmt::format("{:.3f} ({:.3f}, {:.3f})", d[i][law].mean(), d[i][law].quantile(0.01), d[i][law].quantile(0.99));
    }
    rows.push_back(row);
  }
}

void add_piles(std::vector<Row>& rows) {
  Row forces{"splits in a loaded pile: sum of normal forces, after / before", {}};
  Row energy{"the same: elastic energy, after / before", {}};
  Row peak{"the same: peak of the kinetic energy / elastic energy before", {}};
  for (std::size_t law = 0; law < kLaws.size(); ++law) {
    const piles::SplitEffect effect = piles::split_effect(piles::scene_of(kLaws[law]));
    forces.cells[law] = fmt::format("{:.4f}", effect.normal);
    energy.cells[law] = fmt::format("{:.3f}", effect.elastic);
    peak.cells[law] = fmt::format("{:.3f}", effect.peak);
  }
  rows.insert(rows.end(), {forces, energy, peak});
}

struct TouchingPair {
  alignas(32) double x[2][common::kMaxParticleVertices];
  alignas(32) double y[2][common::kMaxParticleVertices];
  int size[2];
  common::PairFeature feature;
  common::OutlineView view(int i) const { return {x[i], y[i], size[i], common::padded_size(size[i])}; }
};

template <class Law>
double seconds_of(std::vector<TouchingPair>& pairs, const dem::ContactConstants& constants, double& sink) {
  const std::clock_t start = std::clock();
  for (int k = 0; k < 20; ++k) {
    for (TouchingPair& p : pairs) {
      common::OverlapOutline outline;
      const common::Overlap o = common::overlap(p.view(0), p.view(1), p.feature, Law::kOutline ? &outline : nullptr);
      const dem::NormalAction action = Law::action(o, outline, constants);
      sink += action.force + action.energy + (action.normal + action.point).squaredNorm();
    }
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void add_cost(std::vector<Row>& rows) {
  const dem::State& state = bench::pile();
  std::vector<TouchingPair> pairs;
  int two_sided = 0;
  for (const dem::Contact& c : state.contacts) {
    const auto& p = state.particles;
    TouchingPair& pair = pairs.emplace_back();
    for (const int side : {0, 1}) {
      const std::int32_t i = side == 0 ? c.a : c.b;
      const auto outline = p.outline(static_cast<std::size_t>(i));
      const common::Polygon world = contacts::placed({outline.begin(), outline.end()}, p.position[i], p.angle[i]);
      pair.size[side] = common::pack_outline(world.begin(), world.end(), pair.x[side], pair.y[side]).size;
    }
    common::OverlapOutline outline;
    common::overlap(pair.view(0), pair.view(1), pair.feature, &outline);
    two_sided += outline.size > 0;
  }
  const dem::ContactConstants constants{1, 1, 0.47};
  std::array<double, kLaws.size()> best;
  best.fill(std::numeric_limits<double>::infinity());
  double sink = 0;
  for (int round = 0; round < 50; ++round) {
    const std::array seconds = {
        seconds_of<dem::MeanDepthLaw>(pairs, constants, sink), seconds_of<dem::AreaLaw>(pairs, constants, sink),
        seconds_of<dem::PotentialLaw>(pairs, constants, sink), seconds_of<dem::FoundationLaw>(pairs, constants, sink)};
    for (std::size_t law = 0; law < kLaws.size(); ++law) best[law] = std::min(best[law], seconds[law]);
  }
  if (!(sink > 0)) std::abort();
  Row row{fmt::format("cost of overlap and law, over that of `area` ({:.0f} % of the contacts have corners of both)",
                      100.0 * two_sided / static_cast<double>(pairs.size())),
          {}};
  for (std::size_t law = 0; law < kLaws.size(); ++law) row.cells[law] = fmt::format("{:.2f}", best[law] / best[1]);
  rows.push_back(row);
}

}  // namespace

int main(int argc, char** argv) {
  const int collisions = argc > 1 ? std::atoi(argv[1]) : 4000;
  const int cuts = argc > 2 ? std::atoi(argv[2]) : 10000;
  std::vector<Row> rows;
  add_collisions(rows, contacts::Bodies::whole, collisions);
  add_collisions(rows, contacts::Bodies::fragments, collisions);
  add_cuts(rows, cuts);
  add_piles(rows);
  add_cost(rows);
  fmt::print("| | `mean_depth` 1e9 N/m | `area` 5e9 N/m^2 | `potential` 1e9 N/m | `foundation` 5e9 N/m^2 |\n");
  fmt::print("|---|---|---|---|---|\n");
  for (const Row& row : rows) fmt::print("| {} | {} |\n", row.title, fmt::join(row.cells, " | "));
}
