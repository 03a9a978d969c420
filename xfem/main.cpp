// The `xfem` executable: command line in, exit code out.
#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app{"Breakage analysis of particles by extended finite elements"};
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return 0;
}
