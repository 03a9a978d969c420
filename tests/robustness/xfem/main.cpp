// Random growth steps of random cracks.
//   growth_walks --nodes 75 --steps 1000000 --threads 2      all families, equal shares
//   growth_walks --case corners:300:12345                    one walk
// Exit codes: 0 all states right; 1 a wrong one, named by a case that reproduces it; 2 bad input.
#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "common/error.hpp"
#include "tests/robustness/xfem/growth_walk.hpp"

namespace {

using namespace growth_walks;

struct Arguments {
  std::int64_t steps = 100000;
  std::int64_t first = 0;
  int nodes = 75;
  int every = 20;
  int threads = 1;
  double friction = 0;
  std::vector<std::string> only;
  std::string case_name;
};

/// Long enough for cracks through the whole particle.
int steps_of_walk(int nodes) {
  return std::max(40, 2 * static_cast<int>(4 * std::sqrt(static_cast<double>(nodes))));
}

/// Whole batches of walks until the steps are reached, so that the counts do not depend on the threads.
Tally run_family(const Family& family, const Arguments& arguments, std::int64_t steps) {
  constexpr std::int64_t kBatch = 200;
  Tally total;
  for (std::int64_t first = arguments.first; total.steps < steps; first += kBatch) {
    std::vector<Tally> tallies(kBatch);
#pragma omp parallel for schedule(dynamic)
    for (std::int64_t i = 0; i < kBatch; ++i) {
      tallies[i] =
          walk(family, arguments.nodes, first + i, steps_of_walk(arguments.nodes), arguments.every, arguments.friction);
    }
    for (const Tally& tally : tallies) total.add(tally);
  }
  return total;
}

void print(const std::string& name, const Tally& tally) {
  fmt::print(
      "{:17} {:8} {:9} {:9} {:7} {:8} {:7} {:8} {:4} {:4.0e} {:9.1e} {:9.1e} {:6} {:9.1e} "
      "{:4}/{:4}/{:4}/{:4}/{:4}/{:4}\n",
      name, tally.walks, tally.steps, tally.separated, tally.hinged, tally.refused, tally.merged, tally.closed,
      tally.most_functions, tally.smallest_part, tally.worst_residual, tally.worst_over_load, tally.turned,
      tally.worst_virial, tally.singular, tally.impure, tally.not_finite, tally.over_limit, tally.virial_over_limit,
      tally.unsettled);
}

}  // namespace

int main(int count, char** values) {
  Arguments arguments;
  CLI::App app{"Random growth steps of random cracks in random particles"};
  app.add_option("--steps", arguments.steps, "growth steps, shared equally by the families");
  app.add_option("--nodes", arguments.nodes, "nodes per particle");
  app.add_option("--first", arguments.first, "number of the first walk");
  app.add_option("--every", arguments.every, "compare each so many steps with a new solver, 0: none");
  app.add_option("--families", arguments.only, "these families only");
  app.add_option("--threads", arguments.threads, "threads");
  app.add_option("--friction", arguments.friction, "of closed crack faces");
  app.add_option("--case", arguments.case_name, "one walk: FAMILY:NODES:NUMBER");
  CLI11_PARSE(app, count, values);
  omp_set_num_threads(arguments.threads);
  fmt::print("{:17} {:>8} {:>9} {:>9} {:>7} {:>8} {:>7} {:>8} {:>4} {:>5} {:>9} {:>9} {:>6} {:>9} {}\n", "family",
             "walks", "steps", "separated", "hinged", "refused", "merged", "closed", "most", "part", "residual",
             "over load", "turned", "virial", "singular/impure/not finite/residual/virial/unsettled");
  Tally total;
  if (!arguments.case_name.empty()) {
    const std::size_t a = arguments.case_name.find(':');
    const std::size_t b = arguments.case_name.find(':', a + 1);
    const Family* family = family_named(arguments.case_name.substr(0, a));
    if (family == nullptr || b == std::string::npos) {
      fmt::print(stderr, "--case: \"{}\" is not FAMILY:NODES:NUMBER\n", arguments.case_name);
      return 2;
    }
    const int nodes = std::atoi(arguments.case_name.c_str() + a + 1);
    total = walk(*family, nodes, std::atoll(arguments.case_name.c_str() + b + 1), steps_of_walk(nodes), 1,
                 arguments.friction);
    print(family->name, total);
  } else {
    std::vector<const Family*> chosen;
    for (const Family& family : families()) {
      if (arguments.only.empty() || std::count(arguments.only.begin(), arguments.only.end(), family.name)) {
        chosen.push_back(&family);
      }
    }
    if (chosen.empty()) {
      fmt::print(stderr, "--families: no family of that name\n");
      return 2;
    }
    for (const Family* family : chosen) {
      const Tally tally = run_family(*family, arguments, arguments.steps / static_cast<std::int64_t>(chosen.size()));
      print(family->name, tally);
      std::cout.flush();
      total.add(tally);
    }
    print("all", total);
  }
  for (const std::string& failure : total.failures) fmt::print("{}\n", failure);
  return total.wrong() == 0 ? 0 : 1;
}
