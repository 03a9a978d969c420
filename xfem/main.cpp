// The `xfem` executable: command line in, exit code out.
//
//   xfem solve FRAME.h5 --config CASE.yaml --previous SPLIT.h5 --out SPLIT.h5
//   xfem serve --config CASE.yaml
//   xfem lab configs/lab/brazilian.yaml --out runs/brazilian --set mesh.nodes=300
//   xfem check CASE.yaml
//   xfem explain CASE.yaml
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "common/config/lab_test.hpp"
#include "common/config/scene.hpp"
#include "common/error.hpp"
#include "common/memory.hpp"
#include "xfem/explain.hpp"
#include "xfem/interrupts.hpp"
#include "xfem/lab/laboratory.hpp"
#include "xfem/profile.hpp"
#include "xfem/serve.hpp"

namespace {

struct Arguments {
  std::string frame, config, previous, out, profile;
  common::Overrides overrides;
  int threads = 0, repeats = 1;
};

void say(const std::string& text) {
  fmt::print(stderr, "xfem: {}\n", text);
}

void tell_profile(const std::string& file, const xfem::PhaseSeconds& seconds, const xfem::PhaseCounts& counts) {
  if (file == "-") {
    fmt::print(stderr, "{}\n", xfem::profile_event(seconds, counts));
  } else if (!file.empty()) {
    xfem::write_profile(file, seconds, counts);
  }
}

common::Scene breakable_scene(const Arguments& arguments) {
  common::Scene scene = common::read_scene(arguments.config, arguments.overrides);
  if (!scene.effects.breakage)
    throw common::bad_input(
        fmt::format("{}: its effects do not name breakage, so there is nothing to analyse", arguments.config));
  return scene;
}

void solve(const Arguments& arguments) {
  xfem::SplitService service(breakable_scene(arguments), arguments.threads, say);
  std::optional<std::filesystem::path> previous;
  if (!arguments.previous.empty()) previous = arguments.previous;
  const auto& answer = service.solve(arguments.frame, previous, arguments.out);
  say(xfem::summary_line(answer.split));
  tell_profile(arguments.profile, answer.seconds, answer.counts);
}

void serve(const Arguments& arguments) {
  xfem::SplitService service(breakable_scene(arguments), arguments.threads, say);
  const xfem::Profile sums = xfem::serve(service, std::cin, std::cout);
  tell_profile(arguments.profile, sums.seconds, sums.counts);
}

void lab(const Arguments& arguments) {
  say(xfem::run_lab_test(common::read_lab_test(arguments.config, arguments.overrides), arguments.out,
                         arguments.repeats));
}

void check(const Arguments& arguments) {
  if (xfem::is_lab_test(arguments.config))
    common::read_lab_test(arguments.config, arguments.overrides);
  else
    common::read_scene(arguments.config, arguments.overrides);
  fmt::print("{}: ok\n", arguments.config);
}

void explain(const Arguments& arguments) {
  fmt::print("{}", xfem::is_lab_test(arguments.config)
                       ? xfem::explain(common::read_lab_test(arguments.config, arguments.overrides))
                       : xfem::explain(common::read_scene(arguments.config, arguments.overrides)));
}

void add_overrides(CLI::App& command, Arguments& arguments) {
  command.add_option("--set", arguments.overrides, "Override a key: a.b=value (may be repeated)")
      ->take_all()
      ->allow_extra_args(false);
}

void add_case_options(CLI::App& command, Arguments& arguments) {
  command.add_option("--config", arguments.config, "Scene (YAML)")->required();
  command.add_option("--threads", arguments.threads, "Threads; 0: one per processor")->check(CLI::Range(0, 1024));
  add_overrides(command, arguments);
}

int run(int argc, char** argv) {
  CLI::App app{"Breakage analysis of rock particles by the extended finite element method"};
  app.require_subcommand(1);
  Arguments arguments;
  const auto command = [&](const char* name, const char* description, void (*action)(const Arguments&)) {
    CLI::App* added = app.add_subcommand(name, description);
    added->callback([action, &arguments] { action(arguments); });
    return added;
  };

  CLI::App* solving = command("solve", "Analyse one saved contact state", solve);
  solving->add_option("frame", arguments.frame, "Frame (HDF5)")->required();
  solving->add_option("--previous", arguments.previous, "Split of the frame before: the cracks so far");
  solving->add_option("--out", arguments.out, "Split to write (HDF5)")->required();
  CLI::App* serving = command("serve", "Stay resident: `solve FRAME PREVIOUS|- OUT` lines on stdin", serve);
  for (CLI::App* one : {solving, serving}) {
    one->add_option("--profile", arguments.profile,
                    "Write seconds and counts per phase (JSON); -: as one line to stderr");
    add_case_options(*one, arguments);
  }

  CLI::App* testing = command("lab", "Run a single-specimen laboratory test", lab);
  testing->add_option("test", arguments.config, "Laboratory test (YAML)")->required();
  testing->add_option("--out", arguments.out, "Directory for summary.json, result.h5 and figures")->required();
  testing->add_option("--repeat", arguments.repeats, "Runs; the times of summary.json are their medians")
      ->check(CLI::Range(1, 1000));
  add_overrides(*testing, arguments);

  for (CLI::App* reading : {command("check", "Validate a scene or a laboratory test", check),
                            command("explain", "Show the resolved configuration and the model's choices", explain)}) {
    reading->add_option("case", arguments.config, "Scene or laboratory test (YAML)")->required();
    add_overrides(*reading, arguments);
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(common::ExitCode::bad_input);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  common::keep_freed_memory();
  xfem::exit_on_signals();
  try {
    return run(argc, argv);
  } catch (const common::Error& error) {
    say(fmt::format("error: {}", error.what()));
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    say(fmt::format("error: {}", error.what()));
    return static_cast<int>(common::ExitCode::numerical_failure);
  }
}
