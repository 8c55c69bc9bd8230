#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "common/diagnosis/rig_checks.h"
#include "tools/evit/commands.h"

namespace evit::commands {
namespace {

void AddShow(CLI::App* config) {
  struct Options {
    std::string file;
    bool changes = false, markdown = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* show = config->add_subcommand(
      "show", "Print every value in force, with unit, range, meaning and origin; itself a settings file");
  auto* file = show->add_option("file", o->file, "Settings file (default: none, EVIT's defaults)");
  show->add_flag("--changes", o->changes, "Only what differs from the defaults");
  show->add_flag("--markdown", o->markdown, "All keys of all methods as tables")->excludes(file);
  show->callback([o] {
    const LoadedSettings loaded = o->file.empty() ? LoadedSettings() : LoadSettings(o->file);
    const std::string text =
        o->markdown ? SettingsMarkdown()
                    : CommentedSettings(loaded, o->changes ? ShowKind::kChanges : ShowKind::kAll);
    std::fputs(text.c_str(), stdout);
  });
}

void CheckSettings(const std::string& file) {
  const LoadedSettings loaded = LoadSettings(file);
  for (const std::string& note : loaded.notes) std::printf("%s\n", note.c_str());
  if (!loaded.notes.empty()) {
    std::printf(
        "%s: keys of an earlier version are read at their new places; `evit config show --changes %s` "
        "prints a file that has them there\n",
        file.c_str(), file.c_str());
  }
  std::printf("%s: good\n", file.c_str());
}

// A rig that can be read may still be that of another resolution: what the doctor says of it by itself.
void CheckRigFile(const std::string& file) {
  bool good = true;
  for (const diagnosis::Finding& finding : diagnosis::CheckRig(LoadRig(file))) {
    if (finding.severity == diagnosis::Severity::kGood) continue;
    std::printf("%s: warning: %s %s; %s\n", file.c_str(), finding.figure.c_str(), finding.what.c_str(),
                finding.remedy.c_str());
    good = false;
  }
  if (good) std::printf("%s: good\n", file.c_str());
}

void AddCheck(CLI::App* config) {
  struct Options {
    std::vector<std::string> files, rigs;
  };
  auto o = std::make_shared<Options>();
  CLI::App* check = config->add_subcommand("check", "Say whether settings (and rig) files can be used");
  check->add_option("files", o->files, "Settings files");
  check->add_option("--rig", o->rigs, "Rig files");
  check->callback([o] {
    if (o->files.empty() && o->rigs.empty()) throw std::runtime_error("give a settings file, or --rig FILE");
    for (const std::string& file : o->files) CheckSettings(file);
    for (const std::string& file : o->rigs) CheckRigFile(file);
  });
}

}  // namespace

void AddConfigCommand(CLI::App* app) {
  CLI::App* config = app->add_subcommand("config", "Show and check settings files");
  config->require_subcommand(1);
  AddShow(config);
  AddCheck(config);
}

}  // namespace evit::commands
