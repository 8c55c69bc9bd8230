#include "tools/run/run_inputs.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "common/evaluation/trajectory_pairs.h"
#include "common/files/decimal_time.h"
#include "common/imu/imu_plausibility.h"
#include "common/localization/prior_text.h"
#include "common/map/map_file.h"
#include "common/map/photometric_map.h"
#include "tools/run/extrinsics_check.h"
#include "tools/run/log_span.h"
#include "tools/run/sensor_check.h"

namespace evit::run {
namespace {

Trajectory ReadTruth(const std::string& path) {
  TumSkipped skipped;
  Trajectory truth = ReadTum(path, &skipped);
  if (skipped.rows > 0) std::fprintf(stderr, "evit run: %s\n", skipped.Text(path).c_str());
  return truth;
}

// An IMU that cannot be tracked with, told before anything is started.
void CheckImu(const RunJob& job, const LogSpan& span, const std::optional<SE3>& T_map_body) {
  if (job.tolerate.any_imu) return;
  if (const std::string complaint = ImuComplaint(span.imu); !complaint.empty()) {
    throw std::runtime_error(
        job.log + ": " + complaint +
        "; import it again with --accel-unit or --gyro-unit, or run it as it is with --any-imu");
  }
  if (T_map_body) {
    std::vector<ImuSample> first;
    for (const ImuSample& s : span.imu) {
      if (s.t >= span.begin && s.t < span.begin + kMicrosPerSecond / 2) first.push_back(s);
    }
    if (const std::string complaint = GravityComplaint(first, T_map_body->q); !complaint.empty())
      throw std::runtime_error((job.initial_from.empty() ? "--initial-pose" : job.initial_from) + ": " +
                               complaint +
                               " Without a start pose the place is looked for; --any-imu runs it as it is");
  }
}

std::optional<SE3> StartPose(const RunJob& job, Utime begin) {
  if (job.initial_pose) return job.initial_pose;
  if (job.initial_from.empty()) return std::nullopt;
  const Trajectory truth = ReadTruth(job.initial_from);
  // The truth may begin a little later than the log.
  SE3 pose;
  for (Utime t = begin; t < begin + kMicrosPerSecond / 2; t += 1000) {
    if (PoseAt(truth, t, &pose, MaxHole(truth))) return pose;
  }
  throw std::runtime_error(job.initial_from + ": has no pose at the start of the log (" +
                           DecimalSeconds(begin) + " s); are both from the same sequence?");
}

}  // namespace

RunInputs PrepareRun(const RunJob& job) {
  RunInputs inputs;
  const Camera camera = LoadRig(job.rig).camera;
  const PipelineOptions options = LoadOptionsFor(camera, job.config);
  inputs.settings = SettingsText(options);
  const bool photometric = options.method == PipelineOptions::Method::kEvpt;
  const std::string settings = job.config.empty() ? "the default settings" : job.config;
  if (photometric && job.photometric_map.empty()) {
    throw std::runtime_error(settings + ": method EVPT needs a photometric map: give --photometric-map FILE");
  }
  if (!photometric && !job.photometric_map.empty()) {
    throw std::runtime_error(settings +
                             ": only method EVPT uses a photometric map: leave --photometric-map out, or "
                             "give --config config/evpt.textproto");
  }
  if (!photometric && job.map.empty()) {
    throw std::runtime_error("--map is required: the semi-dense map that this method tracks against");
  }
  PointMap map;
  if (!job.map.empty()) {
    map = LoadMap(job.map).map;
    RequireMetres(Summarize(map), job.map);
  }
  if (!job.photometric_map.empty()) LoadPhotometricMap(job.photometric_map);
  const LogSpan span = ReadLogSpan(job);
  CheckSensor(job, span, camera);
  if (span.imu.empty() && options.method != PipelineOptions::Method::kEvt) {
    throw std::runtime_error(job.log + ": holds no IMU messages, which " + settings +
                             " need: import it again with --imu FILE where another file holds them, or "
                             "track by events alone with --config config/evt.textproto and a start pose");
  }
  inputs.log_begin = span.log_begin;
  inputs.begin = span.begin;
  inputs.end = span.end;
  inputs.n_events = span.n_events;
  inputs.log_prefix = span.prefix;
  inputs.lost_bytes = span.lost_bytes;
  inputs.has_imu = !span.imu.empty();
  inputs.start = StartPose(job, inputs.begin);
  ParsePlacePrior(job.place.near, job.place.height, job.place.yaw);
  if (!inputs.start && options.method != PipelineOptions::Method::kEvit) {
    throw std::runtime_error(settings +
                             ": methods EVT and EVPT need a start: give --initial-pose or --initial-from");
  }
  CheckImu(job, span, inputs.start);
  if (!job.truth.empty()) {
    for (const StampedPose& s : ReadTruth(job.truth)) {
      if (s.t >= inputs.begin && s.t <= inputs.end) inputs.truth.push_back(s);
    }
    if (inputs.truth.empty()) {
      throw std::runtime_error(job.truth + ": has no pose during the log; are both from the same sequence?");
    }
  }
  if (!job.tolerate.any_rig && !map.points.empty()) CheckExtrinsics(job, inputs, span, map);
  std::error_code error;
  std::filesystem::create_directories(job.out, error);
  if (error || access(job.out.c_str(), W_OK) != 0) {
    throw std::runtime_error(job.out + ": is not a writable folder" +
                             (error ? " (" + error.message() + ")" : ""));
  }
  // Results of an earlier run must not pass for this one's.
  for (const char* name : {"trajectory.tum", "smoothed.tum", "covariance.csv", "report.json",
                           "trajectory.png", "consistency.png"}) {
    std::filesystem::remove(std::filesystem::path(job.out) / name, error);
  }
  return inputs;
}

}  // namespace evit::run
