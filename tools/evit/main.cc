#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "common/files/staged_file.h"
#include "common/service/help_layout.h"
#include "tools/evit/commands.h"
#include "tools/evit/input_files.h"
#include "tools/evit/usage_error.h"

namespace {

// CLI11 would only say that a subcommand is required.
void RequireKnownCommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_name() == argv[1]) return;
  throw std::runtime_error(evit::commands::UnknownCommand(app, argv[1]));
}

int Main(int argc, char** argv) {
  CLI::App app{
      "EVIT: tracks an event camera and an IMU in 6-DoF against a semi-dense map.\n"
      "A first run: evit simulate, evit import vector, evit run; see README.md."};
  app.set_version_flag("--version", EVIT_VERSION);
  app.require_subcommand(1);
  evit::LayOutHelp(&app);
  evit::commands::AddImportCommand(&app);
  evit::commands::AddExportCommand(&app);
  evit::commands::AddFeedCommand(&app);
  evit::commands::AddMapCommand(&app);
  evit::commands::AddSimulateCommand(&app);
  evit::commands::AddRunCommand(&app);
  evit::commands::AddLocateCommand(&app);
  evit::commands::AddEvalCommand(&app);
  evit::commands::AddCalibrateCommand(&app);
  evit::commands::AddOverlapCommand(&app);
  evit::commands::AddDoctorCommand(&app);
  evit::commands::AddConfigCommand(&app);
  evit::commands::AddPaperCommand(&app);
  evit::commands::AddUpCommand(&app);
  evit::commands::AddProcmanCommands(&app);
  evit::commands::AddMonitorCommand(&app);
  evit::commands::AddTopCommand(&app);
  evit::commands::AddRenderCommand(&app);
  evit::commands::CheckInputs(&app);
  try {
    if (argc < 2) {
      std::fputs(app.help().c_str(), stderr);
      return static_cast<int>(CLI::ExitCodes::RequiredError);
    }
    RequireKnownCommand(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return evit::commands::SayUsageError(app, error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: error: %s\n", evit::commands::CommandName(app).c_str(), error.what());
    return 1;
  }
  return 0;
}

// What a command printed may be its whole result. A reader that went away (| head) had enough.
int Flushed(int code) {
  const bool whole = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;  // also of what went out before
  if (whole || errno == EPIPE || code != 0) return code;
  std::perror("evit: error: standard output");
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  evit::RemoveStagedFilesOnSignals();
  try {
    return Flushed(Main(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "evit: error: %s\n", error.what());
    return 1;
  }
}
