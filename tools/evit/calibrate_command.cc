#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/files/made_folder.h"
#include "common/geometry/pose_text.h"
#include "tools/calibration/calibration_report.h"
#include "tools/calibration/overlap_run.h"
#include "tools/calibration/recorded_motion.h"
#include "tools/evit/commands.h"
#include "tools/evit/data_file.h"
#include "tools/evit/interruptible.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/run/run.h"

namespace evit::commands {
namespace {

constexpr int kNothingLearned = 2;  // exit code (docs/reference/exit-codes.md)

struct CalibrateOptions {
  run::RunJob job;  // the event-only run
  std::string pose, from, seconds, out, poses, truth;
};

// Runs the event-only tracker; the file of its poses.
std::string Track(CalibrateOptions* o) {
  run::RunJob& job = o->job;
  if (o->pose.empty() && o->from.empty()) {
    throw std::runtime_error(
        "a start pose is missing: --initial-pose \"x y z qx qy qz qw\", as evit locate --log " + job.log +
        " --map " + job.map + " --rig " + job.rig +
        " finds it, or --initial-from FILE; with known poses, --truth FILE needs none");
  }
  if (!o->pose.empty()) job.initial_pose = ParsePose("--initial-pose", o->pose);
  job.initial_from = o->from;
  if (!o->seconds.empty()) job.play.seconds = ParseSeconds(o->seconds);
  if (job.config.empty()) job.config = DataFile("config/evt_paper.textproto");
  if (LoadOptions(job.config).method != PipelineOptions::Method::kEvt) {
    throw std::runtime_error(
        job.config +
        ": expected evt { }, as in config/evt_paper.textproto: poses that used the IMU already "
        "depend on the extrinsics");
  }
  if (job.out.empty()) job.out = o->out + ".evt";
  job.command = "evit calibrate";
  std::printf("tracking the camera by its events alone\n");
  std::fflush(stdout);
  const MadeFolder made(job.out);
  if (const int code = run::Run(job); code == 130) {
    // A part of the camera's motion is of no use; the folder goes unless it was there.
    if (made.Remove()) std::printf("interrupted: %s is removed again\n", job.out.c_str());
    throw CLI::RuntimeError(code);
  }
  return job.out + "/trajectory.tum";
}

// By the overlap of map and events at known poses.
void CalibrateWithTruth(const CalibrateOptions& o) {
  calibration::OverlapFiles files{o.job.log, o.job.map, o.truth, {}};
  if (!o.seconds.empty()) files.seconds = ParseSeconds(o.seconds);
  const Rig before = LoadRig(o.job.rig);
  const Trajectory body = calibration::ReadTruth(files);
  std::printf("reading %s\n", o.job.log.c_str());
  std::fflush(stdout);
  OverlapCalibration found;
  RunUntilSignal("evit calibrate", [&](const auto& check) {
    const std::vector<MapView> views =
        calibration::ReadViews(files, before, body, calibration::CalibrationViews(), check);
    std::printf("calibrating from %zu views\n", views.size());
    std::fflush(stdout);
    OverlapCalibrationOptions options;
    options.between_steps = check;
    found = CalibrateByOverlap(views, body, before, options);
  });
  if (!found.success) throw std::runtime_error("not calibrated: " + found.reason);
  std::printf("%s", calibration::OverlapText(before, found).c_str());
  if (o.out.empty()) return;
  WriteRig(o.out, calibration::Calibrated(before, found), LoadRigName(o.job.rig),
           calibration::OverlapRigComment(before, found,
                                          "From " + o.job.log + ", " + o.job.map + " and " + o.truth +
                                              ", starting from " + o.job.rig + "."));
  std::printf("rig file: %s\n", o.out.c_str());
}

void RequireOutputs(const CalibrateOptions& o) {
  RequireOutput("--out", o.out);
  RequireNotAnInput("--out", o.out, {o.job.log, o.job.map, o.job.config, o.poses, o.truth, o.from});
  RequireOutputFolder("--work", o.job.out);
}

void Calibrate(CalibrateOptions* o) {
  RequireOutputs(*o);
  if (!o->truth.empty()) return CalibrateWithTruth(*o);
  if (o->out.empty())
    throw std::runtime_error(
        "--out is missing: the rig file to write (only with --truth it may be left out)");
  const run::RunJob& job = o->job;
  const Rig before = LoadRig(job.rig);
  const std::string poses = o->poses.empty() ? Track(o) : o->poses;
  const Trajectory camera = calibration::CameraOf(ReadTrajectory(poses), before);
  std::printf("\ncalibrating from %zu poses\n", camera.size());
  std::fflush(stdout);
  const CameraImuCalibration found =
      CalibrateCameraImu(camera, calibration::ReadImu(job.log, before.imu_noise), before);
  if (!found.success) {
    throw std::runtime_error("not calibrated: " + found.reason + "; " + poses + " holds the camera's motion");
  }
  std::printf("%s", calibration::CalibrationText(before, found).c_str());
  const SE3 start = camera.front().pose * found.values.T_body_camera.Inverse();
  const std::string advice = calibration::TiltAdvice(found, job.map, start);
  std::printf("%s%s", advice.empty() ? "" : "\n", advice.c_str());
  if (!found.rig.learned_any()) {
    std::fflush(stdout);
    std::fprintf(stderr,
                 "nothing was learned: keep using %s (%s is not written); record faster motion about two "
                 "axes or more\n",
                 job.rig.c_str(), o->out.c_str());
    throw CLI::RuntimeError(kNothingLearned);
  }
  WriteRig(o->out, calibration::Calibrated(before, found), LoadRigName(job.rig),
           calibration::RigComment(
               before, found, "From " + job.log + " and " + job.map + ", starting from " + job.rig + "."));
  std::printf("rig file: %s\n", o->out.c_str());
}

}  // namespace

void AddCalibrateCommand(CLI::App* app) {
  auto o = std::make_shared<CalibrateOptions>();
  CLI::App* calibrate = app->add_subcommand(
      "calibrate", "Find extrinsics and time offset of camera and IMU, and the tilt of the map");
  calibrate->add_option("--log", o->job.log, "LCM log with EVENTS and IMU (evit import)")->required();
  calibrate->add_option("--map", o->job.map, "Semi-dense map: PCD, PLY or text, metres")->required();
  calibrate->add_option("--rig", o->job.rig, "Rig file to start from")->required();
  auto* pose =
      calibrate->add_option("--initial-pose", o->pose, "Body in the map at the start: \"x y z qx qy qz qw\"");
  auto* from = calibrate->add_option("--initial-from", o->from, "Take the pose from this trajectory (TUM)");
  pose->excludes(from);
  auto* poses = calibrate->add_option(
      "--poses", o->poses,
      "OUT.evt/trajectory.tum of an earlier event-only run with the same rig file, instead "
      "of tracking again");
  auto* truth = calibrate->add_option("--truth", o->truth,
                                      "Known poses of the body in the map (TUM, as evit import writes them): "
                                      "extrinsics and time offset from the "
                                      "overlap of map and events, without tracking and without the IMU");
  for (CLI::Option* other : {pose, from, poses}) truth->excludes(other);
  calibrate->add_option("--out", o->out, "Rig file to write; with --truth only if given");
  calibrate->add_option("--seconds", o->seconds, "A:B in s, use only this part of the log");
  calibrate->add_option("--config", o->job.config,
                        "Event-only tracking (default: config/evt_paper.textproto)");
  calibrate->add_option("--work", o->job.out, "Folder for the event-only run (default: OUT.evt)");
  calibrate->footer(
      "Example: evit calibrate --log calib.lcmlog --map map.pcd --rig rig.textproto --initial-pose \"0 0 1 0 "
      "0 0 1\" "
      "--out calibrated.textproto\n"
      "Record ten to thirty seconds of lively hand-held motion in view of the map, with rotation about all "
      "three axes;\n"
      "tilt the rig by 45 degrees or more in each direction, which separates accelerometer bias from a tilt "
      "of "
      "the map.\n"
      "Camera intrinsics, IMU noise and gravity are taken from the rig file. Its T_body_camera counts with "
      "the "
      "standard\n"
      "deviations that it states in T_body_camera_sigma (else 1 deg and 1 cm), its time offset with 5 ms. "
      "What the "
      "motion\n"
      "does not make observable is listed and stays as it is; where that is everything, nothing is written: "
      "code 2.");
  calibrate->callback([o] { Calibrate(o.get()); });
}

}  // namespace evit::commands
