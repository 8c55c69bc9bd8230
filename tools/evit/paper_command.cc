#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "tools/evit/commands.h"
#include "tools/evit/data_file.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/paper/paper.h"

namespace evit::commands {
namespace {

// The source tree a build tree belongs to; where EVIT is installed, the folder of its data.
std::string SourceTree() { return DataFile(""); }

// Real motions for simulations: EVIT_SHARED_DATA, or the folder beside the source tree.
std::string SharedData() {
  const char* named = std::getenv("EVIT_SHARED_DATA");
  if (named != nullptr) return named;
  const auto beside = std::filesystem::path(SourceTree()) / "../shared/data";
  return std::filesystem::is_directory(beside) ? std::filesystem::canonical(beside).string() : "";
}

}  // namespace

void AddPaperCommand(CLI::App* app) {
  auto o = std::make_shared<paper::PaperOptions>();
  CLI::App* paper = app->add_subcommand("paper", "The paper's tables and figures, with one command");
  paper->add_option("--out", o->out, "Folder for the results; work it already contains is not repeated")
      ->required();
  paper->add_option("--vector", o->vector,
                    "Folder of VECtor's files and maps; sequences not found there are simulated");
  paper->add_option("--config", o->config, "What to run (default: config/paper.textproto)");
  paper->add_option(
      "--only", o->only,
      "Tables (I or normal, II or fast, III or motion_models), sequences and methods to run; the tables "
      "still show everything that is done");
  paper->add_option("--seeds", o->seeds, "Rooms of each simulated sequence (default: the configuration's)")
      ->check(CLI::Range(1, 99));
  paper->add_flag("--quick", o->quick, "Quick trial: one room, short clips");
  paper->add_option("--jobs", o->jobs, "Simulations and runs in parallel (default: 2)")
      ->check(CLI::Range(1, 64));
  paper->footer(
      "Example: evit paper --out paper_result --only I evit evt --quick\n"
      "Ctrl-C keeps everything that is finished; the same command continues from there. A simulation or run "
      "is repeated\n"
      "only when its inputs, its settings or the program changed. OUT/work may be deleted at any time.\n"
      "Without --vector everything is simulated (three rooms, 10 s), with motion recorded in VECtor if the "
      "folder\n"
      "EVIT_SHARED_DATA (default ../shared/data) contains it, and built-in motion otherwise.\n"
      "config/paper.textproto lists what is run.\n"
      "Exit code: 0 all done, 1 something failed, 130 interrupted.");
  paper->callback([o] {
    RequireOutputFolder("--out", o->out);
    if (o->config.empty()) o->config = DataFile("config/paper.textproto");
    o->programs = std::filesystem::read_symlink("/proc/self/exe").parent_path().string();
    o->shared_data = SharedData();
    const int code = paper::MakePaper(*o, CommandLineOfThis(), SourceTree());
    if (code != 0) throw CLI::RuntimeError(code);
  });
}

}  // namespace evit::commands
