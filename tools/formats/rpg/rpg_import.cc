#include "tools/formats/rpg/rpg_import.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "common/config/rig_file.h"
#include "tools/formats/rpg/rpg_events.h"
#include "tools/formats/rpg/rpg_tables.h"
#include "tools/formats/tables/stream_tables.h"

namespace evit::formats {
namespace {

namespace fs = std::filesystem;

constexpr char kRigComment[] =
    "Made by evit import rpg. Camera: calib.txt. imu.rate_hz: measured in imu.txt.\n"
    "IMU noise, where no option said otherwise: MPU6150 of the DAVIS240C; densities from its data sheet, "
    "random\n"
    "walks as usual for its class. T_body_camera: --t-body-camera, identity where it was not given.";

// groundtruth.txt's pose is that of the camera: the camera takes the marker body's place.
SE3 MarkerFromBody(const RpgImport& job) { return job.truth_of_body ? SE3() : job.T_body_camera.Inverse(); }

}  // namespace

ImportSummary ImportRpg(const RpgImport& job, const std::function<void(double)>& progress) {
  if (!fs::is_directory(job.folder)) throw std::runtime_error(job.folder + ": there is no such folder");
  const auto file = [&](const char* name) { return (fs::path(job.folder) / name).string(); };
  Rig rig;
  if (!job.rig_out.empty()) rig.camera = ReadRpgCamera(file("calib.txt"), job.width, job.height);
  RpgEvents events(file("events.txt"), job.width, job.height);
  ImportStreams streams;
  streams.imu_name = file("imu.txt");
  streams.imu = ReadRpgImu(streams.imu_name, &streams.dropped_imu);
  rig.T_body_camera = job.T_body_camera;
  rig.T_marker_body = MarkerFromBody(job);
  if (fs::exists(file("groundtruth.txt"))) {
    streams.truth = ReadPoseTable(file("groundtruth.txt"), &streams.dropped_truth);
    for (StampedPose& s : streams.truth) s.pose = job.T_map_world * s.pose * rig.T_marker_body;
  }
  rig.imu_rate_hz = ImuRate(streams.imu);
  rig.imu_noise = job.imu_noise;
  const ImportSummary summary = ImportLog(job, &events, std::move(streams), progress);
  if (!job.rig_out.empty())
    WriteRig(job.rig_out, rig, "RPG " + fs::canonical(job.folder).filename().string(), kRigComment);
  return summary;
}

}  // namespace evit::formats
