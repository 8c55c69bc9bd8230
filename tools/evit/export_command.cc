#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "common/evaluation/trajectory.h"
#include "tools/evit/commands.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/formats/export/export_log.h"
#include "tools/formats/export/export_results.h"
#include "tools/terminal/progress_bar.h"

namespace evit::commands {
namespace {

void AddExportLog(CLI::App* app, const char* name, const char* text, formats::ExportFormat format) {
  struct Options {
    formats::LogExport job;
    std::string size;
  };
  auto o = std::make_shared<Options>();
  o->job.format = format;
  CLI::App* command = app->add_subcommand(name, text);
  command->add_option("LOG", o->job.log, "Log of evit import")->required();
  command
      ->add_option("--out", o->job.out,
                   format == formats::ExportFormat::kRpg ? "Folder to write to"
                                                         : "File of the events; IMU and truth beside it")
      ->required();
  command->add_flag("--allow-truncated", o->job.allow_truncated,
                    "Of a log that was cut off: export the complete messages");
  if (format == formats::ExportFormat::kEvt3)
    command->add_option("--size", o->size,
                        "WxH of the sensor, for the header (default: what holds all events)");
  command->callback([o] {
    if (!o->size.empty()) ParseSize(o->size, &o->job.width, &o->job.height);
    if (o->job.format == formats::ExportFormat::kRpg) {
      RequireOutputFolder("--out", o->job.out);
    } else {
      RequireOutput("--out", o->job.out);
    }
    RequireNotAnInput("--out", o->job.out, {o->job.log});
    formats::ExportSummary s;
    {
      terminal::ProgressBar bar("exporting " + o->job.log);
      s = formats::ExportLog(o->job, [&](double share) { bar.Show(share); });
    }
    std::printf("%s: %lld events, %lld IMU samples, %lld truth poses\n", o->job.out.c_str(),
                static_cast<long long>(s.n_events), static_cast<long long>(s.n_imu),
                static_cast<long long>(s.n_truth));
  });
}

void AddExportResults(CLI::App* app) {
  struct Options {
    std::string from, format, out, camera_of;
  };
  auto o = std::make_shared<Options>();
  static const std::map<std::string, formats::TrajectoryFormat> kFormats = {
      {"tum", formats::TrajectoryFormat::kTum},
      {"kitti", formats::TrajectoryFormat::kKitti},
      {"euroc", formats::TrajectoryFormat::kEuroc},
      {"mcap", formats::TrajectoryFormat::kMcap}};
  CLI::App* command = app->add_subcommand("results", "A trajectory as TUM, KITTI, EuRoC csv or MCAP");
  command->add_option("FROM", o->from, "Result folder of evit run (its trajectory.tum), or a TUM file")
      ->required();
  command
      ->add_option("--format", o->format,
                   "tum, kitti (no stamps), euroc, or mcap (ROS 2 PoseStamped on /evit/pose)")
      ->required()
      ->check(CLI::IsMember({"tum", "kitti", "euroc", "mcap"}));
  command->add_option("--out", o->out, "File to write")->required();
  command->add_option("--camera-of", o->camera_of,
                      "Rig file or Kalibr's camchain: write poses of its camera, on the camera's clock, "
                      "instead of the body's");
  command->footer("Example: evit export results desk_result --format euroc --out desk.csv");
  command->callback([o] {
    const bool folder = std::filesystem::is_directory(o->from);
    const std::string from = folder ? o->from + "/trajectory.tum" : o->from;
    RequireOutput("--out", o->out);
    RequireNotAnInput("--out", o->out, {from, o->camera_of});
    Trajectory trajectory = ReadTrajectory(from);
    if (!o->camera_of.empty()) trajectory = formats::CameraTrajectory(trajectory, LoadRig(o->camera_of));
    formats::WriteTrajectory(o->out, kFormats.at(o->format), trajectory);
    std::printf("%s: %zu poses%s\n", o->out.c_str(), trajectory.size(),
                o->camera_of.empty() ? "" : " of the camera");
  });
}

}  // namespace

void AddExportCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("export", "Logs and results for other people's tools")->require_subcommand(1);
  AddExportLog(command, "rpg", "RPG's folder of text files", formats::ExportFormat::kRpg);
  AddExportLog(command, "dsec", "DSEC's HDF5 (Zstandard)", formats::ExportFormat::kDsec);
  AddExportLog(command, "evt3", "Metavision RAW, EVT 3.0 (stamps from the first event on)",
               formats::ExportFormat::kEvt3);
  AddExportResults(command);
}

}  // namespace evit::commands
