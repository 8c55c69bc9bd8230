#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "tools/evit/commands.h"
#include "tools/evit/simulate_command.h"

namespace {

int Main(int argc, char** argv) {
  CLI::App app{
      "EVIT: tracks an event camera and an IMU in 6-DoF against a semi-dense map.\n"
      "A first run: evit simulate, evit import vector, evit run; see README.md."};
  app.require_subcommand(1);
  evit::AddImportCommand(&app);
  evit::AddMapCommand(&app);
  evit::AddSimulateCommand(&app);
  evit::AddRunCommand(&app);
  evit::AddEvalCommand(&app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    const auto chosen = app.get_subcommands();
    const std::string name = chosen.empty() ? "" : " " + chosen.front()->get_name();
    std::fprintf(stderr, "evit%s: error: %s\n", name.c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "evit: error: %s\n", error.what());
    return 1;
  }
}
