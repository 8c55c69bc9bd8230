#pragma once

namespace CLI {
class App;
}

/// The subcommands of `evit`. Each adds itself to the program; its work runs when it is chosen on the command
/// line.
namespace evit::commands {

void AddImportCommand(CLI::App* app);
void AddExportCommand(CLI::App* app);
void AddFeedCommand(CLI::App* app);
void AddMapCommand(CLI::App* app);
/// build, check, compare: subcommands of map.
void AddMapBuild(CLI::App* map);
void AddMapCheck(CLI::App* map);
void AddMapCompare(CLI::App* map);
/// merge, crop, transform.
void AddMapEdits(CLI::App* map);
/// photometric, a subcommand of map.
void AddMapPhotometric(CLI::App* map);
void AddSimulateCommand(CLI::App* app);
void AddEvalCommand(CLI::App* app);
void AddCalibrateCommand(CLI::App* app);
void AddOverlapCommand(CLI::App* app);
void AddDoctorCommand(CLI::App* app);
void AddRenderCommand(CLI::App* app);
void AddRunCommand(CLI::App* app);
void AddLocateCommand(CLI::App* app);
/// show, check.
void AddConfigCommand(CLI::App* app);
void AddMonitorCommand(CLI::App* app);
void AddTopCommand(CLI::App* app);
void AddPaperCommand(CLI::App* app);
void AddUpCommand(CLI::App* app);
/// ps, start, stop, restart, logs.
void AddProcmanCommands(CLI::App* app);

}  // namespace evit::commands
