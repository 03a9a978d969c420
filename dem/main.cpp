// dem run CASE.yaml --out DIR [--set key=value]... [--threads N] [--until-frame K] [--resume] [--serve] [--profile F]
// dem contacts PARTICLES.h5 --config CASE.yaml --out FRAME.h5
// dem check CASE.yaml
// dem explain CASE.yaml
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>

#include "common/config/scene.hpp"
#include "common/error.hpp"
#include "common/memory.hpp"
#include "dem/contacts_of.hpp"
#include "dem/explain.hpp"
#include "dem/run.hpp"
#include "dem/serve.hpp"

namespace {

volatile std::sig_atomic_t g_signal = 0;

void remember_signal(int signal) {
  g_signal = signal;
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = remember_signal;
  // Not restarted: a read of the standard input must end.
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  // A file beyond the limit on sizes is to be an error that names it.
  std::signal(SIGXFSZ, SIG_IGN);
}

// People get a line now and then; a driver gets every event.
void print_progress(const std::string& event) {
  std::fprintf(stderr, "%s\n", event.c_str());
}

struct Arguments {
  std::string scene, particles, out, profile;
  common::Overrides overrides;
  int threads = 1;
  long long until_frame = -1;
  bool resume = false, serve = false;
};

int run(const Arguments& arguments) {
  const common::Scene scene = common::read_scene(arguments.scene, arguments.overrides);
  dem::RunOptions options;
  options.directory = arguments.out;
  options.resume = arguments.resume;
  options.profile = arguments.profile;
  options.threads = arguments.threads;
  if (arguments.until_frame >= 0) options.until_frame = arguments.until_frame;

  dem::RunPorts ports;
  ports.progress = print_progress;
  ports.interrupted = [] { return g_signal != 0; };
  if (arguments.serve) ports.exchange = dem::exchange_over(STDIN_FILENO, STDOUT_FILENO, ports.interrupted);

  const dem::RunEnd end = dem::run(scene, options, ports);
  if (end == dem::RunEnd::interrupted || g_signal != 0) return g_signal == SIGTERM ? 143 : 130;
  if (end == dem::RunEnd::finished && arguments.serve) dem::say(STDOUT_FILENO, "done");
  if (end == dem::RunEnd::paused && !options.until_frame) {
    print_progress(fmt::format(
        R"({{"event":"pause","text":"the newest frame waits for its split: run `xfem solve` on it, then `dem run --resume`, or let pipeline/run do both"}})"));
  }
  return 0;
}

// The message for people, for a driver the answer of the protocol, and the exit code.
int fail(const Arguments& arguments, common::ExitCode code, const char* text) {
  std::fprintf(stderr, "dem: error: %s\n", text);
  if (arguments.serve) dem::say(STDOUT_FILENO, fmt::format("error {} {}", static_cast<int>(code), text));
  return static_cast<int>(code);
}

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  common::keep_freed_memory();
  CLI::App app("Discrete elements: an assembly of convex polygons, prepared and sheared in a biaxial test");
  app.require_subcommand(1);
  Arguments a;

  CLI::App* run_command = app.add_subcommand("run", "prepare and shear; write a contact-force frame at each interval");
  run_command->add_option("scene", a.scene, "CASE.yaml")->required();
  run_command->add_option("--out", a.out, "run directory")->required();
  run_command->add_option("--set", a.overrides, "key=value, overrides a key of the scene")->allow_extra_args(false);
  run_command->add_option("--threads", a.threads, "threads")->check(CLI::Range(1, 1024));
  run_command->add_option("--until-frame", a.until_frame, "end at this frame")->check(CLI::NonNegativeNumber);
  run_command->add_flag("--resume", a.resume, "go on from the newest valid frame");
  run_command->add_flag("--serve", a.serve, "stay resident: print each frame on stdout, wait for its split on stdin");
  run_command->add_option("--profile", a.profile,
                          "write seconds and counts per phase to this JSON file; -: as an event to stderr");

  CLI::App* contacts_command = app.add_subcommand("contacts", "contacts and forces of a given configuration, no step");
  contacts_command->add_option("particles", a.particles, "PARTICLES.h5: the particles group of a frame")->required();
  contacts_command->add_option("--config", a.scene, "CASE.yaml")->required();
  contacts_command->add_option("--out", a.out, "FRAME.h5")->required();
  contacts_command->add_option("--set", a.overrides, "key=value")->allow_extra_args(false);

  CLI::App* check_command = app.add_subcommand("check", "validate a scene");
  check_command->add_option("scene", a.scene, "CASE.yaml")->required();
  CLI::App* explain_command = app.add_subcommand("explain", "the resolved scene, its effects, kernel and arrays");
  explain_command->add_option("scene", a.scene, "CASE.yaml")->required();
  for (CLI::App* command : {check_command, explain_command}) {
    command->add_option("--set", a.overrides, "key=value")->allow_extra_args(false);
  }

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(common::ExitCode::bad_input);
  }

  catch_signals();
  try {
    if (*run_command) return run(a);
    const common::Scene scene = common::read_scene(a.scene, a.overrides);
    if (*contacts_command) dem::write_contacts_of(a.particles, scene, a.out);
    if (*check_command) print(fmt::format("{}: valid\n", a.scene));
    if (*explain_command) print(dem::explain(scene));
    return 0;
  } catch (const common::Error& error) {
    return fail(a, error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(a, common::ExitCode::numerical_failure, "out of memory");
  } catch (const std::exception& error) {
    return fail(a, common::ExitCode::io_failure, error.what());
  }
}
