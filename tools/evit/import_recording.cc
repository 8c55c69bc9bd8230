#include "tools/formats/recognition/import_recording.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "common/config/rig_file.h"
#include "common/files/decimal_time.h"
#include "tools/evit/import_options.h"
#include "tools/evit/options.h"
#include "tools/formats/calibration_files/basalt_calibration.h"

namespace evit::commands {
namespace {

void PrintFound(const std::string& path, const formats::RecordingInfo& info) {
  std::printf("%s: %s, %s%s%dx%d\n", path.c_str(), info.format.c_str(), info.sensor.c_str(),
              info.sensor.empty() ? "" : ", ", info.width, info.height);
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
    std::printf("no IMU: evit run needs one; import again with --imu FILE where another file holds it\n");
  }
}

}  // namespace

void AddImportRecording(CLI::App* import) {
  struct Options {
    ImportOptions shared;
    formats::RecordingImport job;
    std::string size, rig, calibration, rig_out;
    formats::RecordingInfo found;
  };
  auto o = std::make_shared<Options>();
  import->add_option("FILE", o->job.paths,
                     "Recording of any format, recognised by its contents: files, or a folder");
  o->shared.AddTo(import, false);
  import->add_option("--size", o->size, "WxH of the sensor in pixels, where the recording does not say it");
  import->add_option("--rig", o->rig, "Calibration; its T_marker_body turns the truth's body into the IMU's");
  auto* calibration = import->add_option("--calibration", o->calibration,
                                         "Calibration in Basalt's JSON (TUM-VIE), for --rig-out");
  import->add_option("--rig-out", o->rig_out, "Rig file to write from it")->needs(calibration);
  import->add_option("--imu", o->job.imu, "Another file with the IMU: a table, HDF5, a bag, ...");
  import->add_option("--imu-offset", o->job.imu_offset,
                     "Seconds to add to IMU stamps to get the clock of the events");
  import->add_flag("--align-clocks", o->job.align_clocks,
                   "Find that offset, up to 2 s around it, from the rotation that events and gyro show");
  import->add_option("--truth", o->job.truth,
                     "Another file with the truth: a table (TUM, EuRoC, ...), HDF5, a bag");
  formats::StreamChoice& choice = o->job.choice;
  import->add_option("--events-topic", choice.events, "Of a bag: events to take (default: the only ones)");
  import->add_option("--imu-topic", choice.imu, "Of a bag: IMU to take (default: the only one)");
  import->add_option("--truth-topic", choice.truth,
                     "Of a bag: pose, odometry or transform to take (default: the only one)");
  import->footer(
      "Example: evit import recording.raw --out recording.lcmlog\n"
      "What is out of order, not finite or outside the sensor is counted and left out.");
  import->callback([o, import] {
    if (!import->get_subcommands().empty()) return;
  if (o->job.paths.empty())
    throw std::runtime_error("no recording given: evit import FILE --out LOG, or evit import --help");
  if (o->shared.out.empty()) throw std::runtime_error("--out is missing: the log to write");
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
  RunImport(o->job.paths.front(), o->job, "none recognised in the recording", [&](const auto& progress) {
    summary = formats::ImportRecording(
        o->job, [&](const formats::RecordingInfo& info) { PrintFound(o->job.paths.front(), info); },
        progress);
    return summary;
  });
  PrintStreams(summary);
});
}  // namespace evit::commands

}  // namespace evit::commands
