#include "tools/evit/commands.h"
#include "tools/evit/import_options.h"

namespace evit::commands {

void AddImportCommand(CLI::App* app) {
  CLI::App* import =
      app->add_subcommand("import", "Turn a recorded sequence into an LCM log")->require_subcommand(0, 1);
  AddImportRecording(import);
  AddImportVector(import);
  AddImportRpg(import);
  AddImportBag(import);
}

}  // namespace evit::commands
