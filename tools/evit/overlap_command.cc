#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "common/config/rig_file.h"
#include "tools/calibration/overlap_statistics.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"

namespace evit::commands {
namespace {

struct OverlapOptionValues {
  calibration::OverlapFiles files;
  std::string rig, seconds, name;
  bool header = false;
};

void PrintOverlap(const OverlapOptionValues& o) {
  calibration::OverlapFiles files = o.files;
  if (!o.seconds.empty()) files.seconds = ParseSeconds(o.seconds);
  const calibration::OverlapStatistics statistics = calibration::MeasureFiles(files, LoadRig(o.rig));
  if (o.header) std::printf("%s", calibration::StatisticsHeader().c_str());
  std::printf("%s", calibration::StatisticsRow(o.name.empty() ? files.log : o.name, statistics).c_str());
}

}  // namespace

void AddOverlapCommand(CLI::App* app) {
  auto o = std::make_shared<OverlapOptionValues>();
  CLI::App* overlap = app->add_subcommand(
      "overlap", "How well map and events of a recording fit at known poses: one row of a table");
  overlap->add_option("--log", o->files.log, "LCM log with EVENTS (evit import)")->required();
  overlap->add_option("--map", o->files.map, "Semi-dense map: PCD, PLY or text, metres")->required();
  overlap->add_option("--rig", o->rig, "Rig file")->required();
  overlap->add_option("--truth", o->files.truth, "Poses of the body in the map (TUM)")->required();
  overlap->add_option("--seconds", o->seconds, "A:B in s from the first pose, use only this part");
  overlap->add_option("--name", o->name, "First column (default: the log)");
  overlap->add_flag("--header", o->header, "Print the table's head first");
  overlap->footer(
      "Example: evit overlap --log desk.lcmlog --map desk/map.pcd --rig desk/rig.textproto --truth "
      "desk/truth.tum "
      "--header");
  overlap->callback([o] { PrintOverlap(*o); });
}

}  // namespace evit::commands
