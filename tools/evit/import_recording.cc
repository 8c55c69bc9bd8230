#include "tools/formats/recognition/import_recording.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "common/files/decimal_time.h"
#include "common/geometry/pose_text.h"
#include "tools/evit/import_options.h"
#include "tools/evit/options.h"
#include "tools/evit/output_names.h"
#include "tools/formats/calibration_files/read_calibration.h"

namespace evit::commands {
namespace {

void PrintFound(const std::string& path, const formats::RecordingInfo& info) {
  std::printf("%s: %s, %s%s%dx%d%s\n", path.c_str(), info.format.c_str(), info.sensor.c_str(),
              info.sensor.empty() ? "" : ", ", info.width, info.height,
              info.measured ? " at least, by its events (--size WxH where you know it)" : "");
  std::fflush(stdout);
}

void PrintStreams(const formats::ImportSummary& s) {
  std::printf("stamps: %s to %s s\n", DecimalSeconds(s.first_event).c_str(),
              DecimalSeconds(s.last_event).c_str());
  if (s.n_imu > 0) {
    std::printf("IMU: %.0f Hz", s.imu_rate_hz);
    if (s.imu_offset != 0)
      std::printf(", %+.6f s added to its stamps", 1e-6 * static_cast<double>(s.imu_offset));
    std::printf("\n");
  } else {
    std::printf(
        "no IMU: import again with --imu FILE where another file holds it; without one evit run needs "
        "--config config/evt.textproto and a start pose\n");
  }
}

struct RecordingOptions {
  ImportOptions shared;
  formats::RecordingImport job;
  std::string size, rig, rig_out, T_body_camera;
  std::vector<std::string> calibration;
  std::optional<formats::FoundCalibration> found;
};

// The rig that --calibration gives, for what was recognised.
void FindCalibration(const formats::RecordingInfo& info, RecordingOptions* o, SE3* T_marker_body) {
  formats::CalibrationChoice choice;
  choice.width = info.width;
  choice.height = info.height;
  if (o->job.choice.events.find("right") != std::string::npos) choice.side = "right";
  if (!o->T_body_camera.empty()) choice.T_body_camera = ParsePose("--t-body-camera", o->T_body_camera);
  o->found = formats::ReadCalibration(o->calibration, choice);
  *T_marker_body = o->found->rig.T_marker_body;
}

void WriteFoundRig(const RecordingOptions& o, const formats::ImportSummary& summary) {
  Rig rig = o.found->rig;
  if (rig.imu_rate_hz == 0) rig.imu_rate_hz = summary.imu_rate_hz > 0 ? summary.imu_rate_hz : 200;
  const std::string name = std::filesystem::path(o.job.paths.front()).filename().string();
  WriteRig(o.rig_out, rig, name,
           "Made by evit import from " + o.found->source + "." +
               (o.found->imu_assumed ? "\nIMU noise: a consumer IMU's, which the calibration does not tell."
                                     : ""));
  std::printf("%s: rig of %s%s\n", o.rig_out.c_str(), o.found->source.c_str(),
              o.found->imu_assumed ? "; IMU noise: a consumer IMU's is assumed" : "");
}

void RequireOthersThanInputs(const RecordingOptions& o) {
  std::vector<std::string> inputs = o.job.paths;
  inputs.insert(inputs.end(), {o.job.imu, o.job.truth, o.rig});
  inputs.insert(inputs.end(), o.calibration.begin(), o.calibration.end());
  RequireNotAnInput("--out", o.shared.out, inputs);
  RequireNotAnInput("--out", o.shared.out + ".truth.tum", inputs);
  if (o.rig_out.empty()) return;
  RequireOutput("--rig-out", o.rig_out);
  RequireNotAnInput("--rig-out", o.rig_out, inputs);
}

void ImportAny(RecordingOptions* o) {
  if (o->job.paths.empty() || o->job.paths.front().empty())
    throw std::runtime_error("no recording given: evit import FILE --out LOG, or evit import --help");
  if (o->shared.out.empty()) throw std::runtime_error("--out is missing: the log to write");
  RequireOthersThanInputs(*o);
  o->shared.Apply(&o->job);
  if (!o->size.empty()) ParseSize(o->size, &o->job.width, &o->job.height);
  if (!o->rig.empty()) {
    const Rig rig = LoadRig(o->rig);
    o->job.T_marker_body = rig.T_marker_body;
    if (o->size.empty()) {
      o->job.width = rig.camera.width;
      o->job.height = rig.camera.height;
    }
  }
  formats::ImportSummary summary;
  const std::string& path = o->job.paths.front();
  RunImport(path, o->job, "none recognised in the recording", [&](const auto& progress) {
    summary = formats::ImportRecording(
        o->job,
        [&](const formats::RecordingInfo& info, SE3* T_marker_body) {
          PrintFound(path, info);
          if (!o->calibration.empty()) FindCalibration(info, o, T_marker_body);
        },
        progress);
    return summary;
  });
  PrintStreams(summary);
  if (!o->rig_out.empty()) WriteFoundRig(*o, summary);
}

}  // namespace

void AddImportRecording(CLI::App* import) {
  auto o = std::make_shared<RecordingOptions>();
  import->add_option("FILE", o->job.paths,
                     "Recording of any format, recognised by its contents: files, or a folder");
  o->shared.AddTo(import, false);
  import->add_option("--size", o->size, "WxH of the sensor in pixels, where the recording does not say it");
  auto* rig = import->add_option("--rig", o->rig,
                                 "Calibration; its T_marker_body turns the truth's body into the IMU's");
  auto* calibration =
      import
          ->add_option(
              "--calibration", o->calibration,
              "Published calibration, for --rig-out and the truth's body: Basalt's JSON (TUM-VIE, with its "
              "T_imu_marker in a second file), M3ED's HDF5, DSEC's cam_to_cam.yaml, Kalibr's "
              "camchain-imucam.yaml (MVSEC)")
          ->excludes(rig);
  import->add_option("--rig-out", o->rig_out, "Rig file to write from it")->needs(calibration);
  import
      ->add_option(
          "--t-body-camera", o->T_body_camera,
          "Camera in the body (IMU) frame, for --rig-out: \"x y z qx qy qz qw\" (default: as calibrated)")
      ->needs(calibration);
  import->add_option("--imu", o->job.imu,
                     "Another file with the IMU: a table, HDF5, a bag, ...; none: no IMU");
  import->add_option("--imu-offset", o->job.imu_offset,
                     "Seconds to add to IMU stamps to get the clock of the events");
  import->add_flag("--align-clocks", o->job.align_clocks,
                   "Find that offset, up to 2 s around it, from the rotation that events and gyro show");
  import->add_option("--truth", o->job.truth,
                     "Another file with the truth: a table (TUM, EuRoC, ...), HDF5, a bag; none: no truth");
  formats::StreamChoice& choice = o->job.choice;
  import->add_option(
      "--events-topic", choice.events,
      "Events to take where there are several: a bag's topic, a group of HDF5, a camera of AEDAT 4");
  import->add_option("--imu-topic", choice.imu, "Of a bag or AEDAT 4: IMU to take (default: the only one)");
  import->add_option("--truth-topic", choice.truth,
                     "Of a bag: pose, odometry or transform to take (default: the only one but /tf)");
  import->add_option("--truth-frame", choice.truth_frame,
                     "Of /tf as --truth-topic: the frame (child_frame_id) whose poses are the truth");
  import->footer(
      "Example: evit import recording.raw --out recording.lcmlog\n"
      "What is out of order, not finite or outside the sensor is counted and left out.");
  import->callback([o, import] {
    if (import->get_subcommands().empty()) ImportAny(o.get());
});
}  // namespace evit::commands

}  // namespace evit::commands
