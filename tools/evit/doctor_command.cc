#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "common/geometry/pose_text.h"
#include "tools/doctor/doctor.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {
namespace {

using diagnosis::Finding;
using diagnosis::Findings;
using diagnosis::Severity;

struct DoctorOptions {
  doctor::Patient patient;
  std::string pose;
  bool json = false;
};

const char* Word(Severity severity) {
  return severity == Severity::kError ? "error" : severity == Severity::kWarning ? "warning" : "good";
}

void PrintJson(const Findings& findings, const std::string& not_checked) {
  nlohmann::json out = nlohmann::json::array();
  for (const Finding& f : findings) {
    out.push_back({{"check", f.check},
                   {"severity", Word(f.severity)},
                   {"figure", f.figure},
                   {"what", f.what},
                   {"remedy", f.remedy}});
  }
  std::printf("%s\n", nlohmann::json{{"findings", out}, {"not_checked", not_checked}}.dump(2).c_str());
}

void PrintText(const Findings& findings, const std::string& not_checked) {
  bool good = false;
  for (const Finding& f : findings) {
    if (f.severity == Severity::kGood) {
      if (!good) std::printf("\nNothing wrong with:\n");
      good = true;
      std::printf("  %-16s %s\n", f.check.c_str(), f.figure.c_str());
    } else {
      std::printf("%s %s: %s\n  measured: %s\n  remedy:   %s\n", Word(f.severity), f.check.c_str(),
                  f.what.c_str(), f.figure.c_str(), f.remedy.c_str());
    }
  }
  if (!not_checked.empty()) std::printf("\nNot checked: %s\n", not_checked.c_str());
}

void Examine(DoctorOptions* o) {
  if (!o->pose.empty()) o->patient.start = ParsePose("--initial-pose", o->pose);
  Findings findings;
  {
    terminal::ProgressBar bar("examining");
    findings = doctor::Examine(o->patient, [&bar](double share) { bar.Show(share); });
  }
  const std::string not_checked = doctor::NotChecked(o->patient);
  o->json ? PrintJson(findings, not_checked) : PrintText(findings, not_checked);
  const Severity worst = findings.empty() ? Severity::kGood : findings.front().severity;
  if (worst != Severity::kGood) throw CLI::RuntimeError(worst == Severity::kError ? 2 : 3);
}

}  // namespace

void AddDoctorCommand(CLI::App* app) {
  auto o = std::make_shared<DoctorOptions>();
  CLI::App* command = app->add_subcommand(
      "doctor", "Find what is wrong with a recording, its rig file or its map, and how to fix it");
  command->add_option("--log", o->patient.log, "LCM log with EVENTS and IMU (evit import)")->required();
  command->add_option("--rig", o->patient.rig, "Rig file that it is to be tracked with")->required();
  command->add_option("--map", o->patient.map, "Semi-dense map: PCD, PLY or text");
  command->add_option("--truth", o->patient.truth,
                      "Known poses of the body (TUM): finds wrong extrinsics, clocks and frames");
  command->add_option("--initial-pose", o->pose, "Body in the map at the start: \"x y z qx qy qz qw\"");
  command->add_option("--seconds", o->patient.seconds, "How much of the log to look at")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", o->json, "Machine-readable output");
  command->footer(
      "Example: evit doctor --log desk.lcmlog --map desk.pcd --rig rig.textproto --truth desk.tum\n"
      "Exit code: 0 nothing is wrong, 1 could not look, 2 an error was found, 3 warnings only.");
  command->callback([o] { Examine(o.get()); });
}

}  // namespace evit::commands
