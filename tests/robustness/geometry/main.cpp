// Differential test of the overlap kernel.
//   overlap_differential --random 1000000 --exact 10000          all families of random and adversarial pairs
//   overlap_differential --harvest runs/a runs/b --pairs 1000000  pairs of real packings
//   overlap_differential --case slivers:12345                    one pair, everything known of it
//   overlap_differential --case harvest:runs/a/frames/000012.h5:40:17:203
// Exit codes: 0 no disagreement; 1 a disagreement, named by a case that reproduces it; 2 bad input.
#include <fmt/format.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "tests/robustness/geometry/harvest.hpp"
#include "tests/robustness/geometry/run_family.hpp"

namespace {

using namespace differential;
namespace fs = std::filesystem;

struct Arguments {
  std::int64_t random = 0;
  std::int64_t first = 0;
  std::vector<std::string> only;
  std::vector<fs::path> directories;
  HarvestOptions harvest;
  std::int64_t exact = 0;
  std::string case_name;
  fs::path json;
  int threads = 1;
};

struct Result {
  std::string name;
  Tally tally;
};

std::vector<Result> run_random(const Arguments& arguments) {
  std::vector<Family> chosen;
  for (const Family& family : families()) {
    if (arguments.only.empty() || std::count(arguments.only.begin(), arguments.only.end(), family.name)) {
      chosen.push_back(family);
    }
  }
  if (chosen.empty()) throw common::bad_input("--families: no family of that name");
  const std::int64_t each = (arguments.random + chosen.size() - 1) / chosen.size();
  const std::int64_t stride = arguments.exact > 0 ? std::max<std::int64_t>(1, arguments.random / arguments.exact) : 0;
  std::vector<Result> results;
  for (const Family& family : chosen) {
    results.push_back({family.name, run_family(family, each, arguments.first, stride, common::overlap)});
  }
  return results;
}

std::vector<fs::path> frames_of(const fs::path& directory) {
  std::vector<fs::path> frames;
  for (const auto& entry : fs::directory_iterator(directory / "frames")) {
    if (entry.path().extension() == ".h5") frames.push_back(entry.path());
  }
  std::sort(frames.begin(), frames.end());
  if (frames.empty()) throw common::bad_input(fmt::format("{}: no frames", directory.string()));
  return frames;
}

std::string case_of(const fs::path& frame, const CaseKey& key) {
  return fmt::format("harvest:{}:{}:{}:{}", frame.string(), key[1], key[2], key[3]);
}

/// Every frame is a task of its own, with an equal share of the pairs.
Result run_harvest(const Arguments& arguments, const fs::path& directory, std::int64_t pairs, std::int64_t exact) {
  const common::Scene scene = common::read_scene(directory / "case.yaml");
  const std::vector<fs::path> frames = frames_of(directory);
  HarvestOptions options = arguments.harvest;
  options.pairs = (pairs + frames.size() - 1) / frames.size();
  options.exact_stride = exact > 0 ? std::max<std::int64_t>(1, pairs / exact) : 0;
  Tally total;
  std::string error;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Tally mine;
    std::string problem;
    try {
      dem::Engine engine = engine_at(frames[k], scene);
      harvest(engine, scene, static_cast<std::int64_t>(k), options, common::overlap, mine);
    } catch (const std::exception& e) {
      problem = fmt::format("{}: {}", frames[k].string(), e.what());
    }
#pragma omp critical
    {
      total.add(mine);
      if (!problem.empty() && (error.empty() || problem < error)) error = problem;
    }
  }
  if (!error.empty()) throw common::bad_input(error);
  for (Failure& failure : total.failures) failure.what += "  " + case_of(frames[failure.key[0]], failure.key);
  return {directory.filename().string(), total};
}

void print_table(const std::vector<Result>& results) {
  fmt::print("{:20} {:>12} {:>12} {:>10} {:>10} {:>9} {:>9} {:>11} {:>8} {:>8}\n", "family", "pairs", "overlapping",
             "exact", "undecided", "worst A", "worst b n", "disagreeing", "unknown", "cached");
  fmt::print("{:20} {:>12} {:>12} {:>10} {:>10} {:>9} {:>9} {:>11} {:>8} {:>8}\n", "", "", "", "checks", "",
             "/ allowed", "/ allowed", "", "ns/pair", "ns/pair");
  Result sum{"sum", {}};
  for (const Result& result : results) sum.tally.add(result.tally);
  std::vector<Result> rows = results;
  rows.push_back(sum);
  for (const auto& [name, t] : rows) {
    const double count = static_cast<double>(std::max<std::int64_t>(1, t.pairs));
    fmt::print("{:20} {:12} {:12} {:10} {:10} {:9.2e} {:9.2e} {:11} {:8.1f} {:8.1f}\n", name, t.pairs, t.overlapping,
               t.exact_checks, t.undecided, t.worst_share, t.worst_chord_share, t.disagreements,
               1e9 * t.seconds_unknown / count, 1e9 * t.seconds_cached / count);
  }
}

void print_failures(const std::vector<Result>& results) {
  for (const auto& [name, t] : results) {
    if (t.oracle_failures > 0) fmt::print("{}: the oracles differ in {} pairs\n", name, t.oracle_failures);
    for (const auto& [kind, count] : t.kinds) fmt::print("{}: {} pairs: {}\n", name, count, kind);
    for (const Failure& failure : t.failures) {
      const bool random =
          std::any_of(families().begin(), families().end(), [&n = name](const Family& f) { return n == f.name; });
      fmt::print("  {}{}\n", failure.what, random ? fmt::format("  --case {}:{}", name, failure.key[0]) : "");
    }
  }
}

void write_json(const fs::path& file, const std::vector<Result>& results) {
  nlohmann::ordered_json document = nlohmann::ordered_json::array();
  for (const auto& [name, t] : results) {
    nlohmann::ordered_json failures = nlohmann::ordered_json::array();
    for (const Failure& failure : t.failures) failures.push_back({{"key", failure.key}, {"what", failure.what}});
    document.push_back(
        {{"family", name},
         {"pairs", t.pairs},
         {"overlapping", t.overlapping},
         {"exact_checks", t.exact_checks},
         {"undecided", t.undecided},
         {"chord_checks", t.chord_checks},
         {"outlines", t.outlines},
         {"not_convex", t.not_convex},
         {"disagreements", t.disagreements},
         {"oracle_failures", t.oracle_failures},
         {"worst_share", t.worst_share},
         {"worst_chord_share", t.worst_chord_share},
         {"ns_unknown", 1e9 * t.seconds_unknown / static_cast<double>(std::max<std::int64_t>(1, t.pairs))},
         {"ns_cached", 1e9 * t.seconds_cached / static_cast<double>(std::max<std::int64_t>(1, t.pairs))},
         {"kinds", t.kinds},
         {"failures", failures}});
  }
  std::ofstream stream(file);
  stream << document.dump(2) << '\n';
  if (!stream.flush()) throw common::io_failure(fmt::format("{}: cannot be written", file.string()));
}

/// FAMILY:SEED or harvest:FRAME:STEP:A:B.
int show_case(const Arguments& arguments) {
  std::vector<std::string> parts;
  std::string rest = arguments.case_name;
  const bool harvested = rest.starts_with("harvest:");
  for (int k = 0; k < (harvested ? 3 : 1); ++k) {
    const auto colon = rest.rfind(':');
    if (colon == std::string::npos) throw common::bad_input("--case: expected FAMILY:SEED or harvest:FRAME:STEP:A:B");
    parts.insert(parts.begin(), rest.substr(colon + 1));
    rest.erase(colon);
  }
  Sample sample;
  if (harvested) {
    const fs::path frame = rest.substr(std::string("harvest:").size());
    const common::Scene scene = common::read_scene(frame.parent_path().parent_path() / "case.yaml");
    dem::Engine engine = engine_at(frame, scene);
    const CaseKey key{0, std::stoll(parts[0]), std::stoll(parts[1]), std::stoll(parts[2])};
    const auto found = harvested_sample(engine, scene, key, arguments.harvest, common::overlap);
    if (!found) throw common::bad_input("--case: no such pair is within the skin at that step");
    sample = *found;
  } else {
    const auto family =
        std::find_if(families().begin(), families().end(), [&](const Family& f) { return f.name == rest; });
    if (family == families().end()) throw common::bad_input(fmt::format("--case: no family '{}'", rest));
    sample.key = {std::stoll(parts[0]), 0, 0, 0};
    make_pair(*family, std::stoull(parts[0]), sample.pair);
  }
  sample.exact = true;
  fmt::print("{}", describe(sample, common::overlap));
  Tally tally;
  check(std::span(&sample, 1), common::overlap, tally);
  for (const auto& [kind, count] : tally.kinds) fmt::print("wrong: {}\n", kind);
  return tally.disagreements + tally.oracle_failures > 0 ? 1 : 0;
}

int run(const Arguments& arguments) {
  omp_set_num_threads(arguments.threads);
  if (!arguments.case_name.empty()) return show_case(arguments);
  std::vector<Result> results;
  if (arguments.random > 0) results = run_random(arguments);
  for (const fs::path& directory : arguments.directories) {
    const auto share = static_cast<std::int64_t>(arguments.directories.size());
    results.push_back(run_harvest(arguments, directory, arguments.harvest.pairs / share, arguments.exact / share));
  }
  print_table(results);
  print_failures(results);
  if (!arguments.json.empty()) write_json(arguments.json, results);
  return std::any_of(results.begin(), results.end(),
                     [](const Result& r) { return r.tally.disagreements + r.tally.oracle_failures > 0; });
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Differential test of the overlap kernel against double-double and rational clips."};
  app.add_option("--random", arguments.random, "pairs of all families together");
  app.add_option("--first", arguments.first, "first seed of each family");
  app.add_option("--families", arguments.only, "only these families");
  app.add_option("--harvest", arguments.directories, "run directories");
  app.add_option("--pairs", arguments.harvest.pairs, "pairs to be harvested from all directories")
      ->default_val(1000000);
  app.add_option("--steps", arguments.harvest.steps, "most steps from a frame")->default_val(400);
  app.add_option("--every", arguments.harvest.every, "steps between two checks of all pairs")
      ->default_val(10)
      ->check(CLI::PositiveNumber);
  app.add_flag("--world", arguments.harvest.world, "harvest in world coordinates, as the engine calls the kernel");
  app.add_option("--exact", arguments.exact, "pairs to be checked in exact arithmetic whatever the first oracle says");
  app.add_option("--case", arguments.case_name, "one pair: FAMILY:SEED or harvest:FRAME:STEP:A:B");
  app.add_option("--json", arguments.json, "file for the table");
  app.add_option("--threads", arguments.threads, "threads; the counts do not depend on them")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  try {
    return run(arguments);
  } catch (const common::Error& error) {
    std::cerr << "overlap_differential: " << error.what() << '\n';
    return 2;
  } catch (const std::logic_error& error) {  // std::stoll
    std::cerr << "overlap_differential: " << arguments.case_name << ": a number was expected: " << error.what() << '\n';
    return 2;
  }
}
