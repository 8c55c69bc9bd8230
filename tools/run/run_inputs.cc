#include "tools/run/run_inputs.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/config/rig_file.h"
#include "common/config/settings_file.h"
#include "common/config/settings_text.h"
#include "common/files/decimal_time.h"
#include "common/localization/prior_text.h"
#include "common/map/map_file.h"
#include "common/map/photometric_map.h"

namespace evit::run {
namespace {

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Sensor time of a message: logs of lcm-logger carry the host's clock.
template <typename Message>
Utime TimeOf(const LogReader& log, const LogEntry& entry, Utime otherwise) {
  std::vector<std::uint8_t> bytes;
  log.Read(entry, &bytes);
  Message message;
  return DecodeChecked(bytes.data(), bytes.size(), &message) ? message.utime : otherwise;
}

// Fills begin, end and n_events.
void ReadSpan(const RunJob& job, RunInputs* inputs) {
  const LogReader log(job.log);
  if (log.trailing_bytes() > 0) {
    throw std::runtime_error(job.log + ": is truncated or damaged after " +
                             std::to_string(log.entries().size()) + " complete messages; make it again");
  }
  const LogEntry *first_imu = nullptr, *last_imu = nullptr, *first_events = nullptr;
  for (const LogEntry& entry : log.entries()) {
    const std::string& channel = log.channel(entry);
    if (EndsWith(channel, "EVENTS") && first_events == nullptr) first_events = &entry;
    if (!EndsWith(channel, "IMU")) continue;
    if (first_imu == nullptr) first_imu = &entry;
    last_imu = &entry;
  }
  if (first_events == nullptr || first_imu == nullptr) {
    throw std::runtime_error(job.log + ": holds no " + (first_imu == nullptr ? "IMU" : "EVENTS") +
                             " messages; make it with `evit import`, or record both channels");
  }
  constexpr Utime kNever = std::numeric_limits<Utime>::max();
  const Utime imu = TimeOf<imu_batch_t>(log, *first_imu, kNever);
  const Utime events = TimeOf<event_packet_t>(log, *first_events, kNever);
  inputs->begin = std::min(imu, events);
  inputs->end = TimeOf<imu_batch_t>(log, *last_imu, -1);
  const Utime log_to_sensor = inputs->end - last_imu->utime;
  if (job.play.seconds) {
    const Utime begin = inputs->begin;
    inputs->begin = begin + static_cast<Utime>(1e6 * job.play.seconds->first);
    inputs->end = std::min(inputs->end, begin + static_cast<Utime>(1e6 * job.play.seconds->second));
  }
  // The first keyframe needs both streams.
  for (const Utime first : {imu, events}) {
    if (first != kNever) inputs->begin = std::max(inputs->begin, first);
  }
  if (inputs->begin >= inputs->end)
    throw std::runtime_error(job.log + ": contains no data in the part that --seconds selects");
  // The number of events follows from a message's length: nothing else has to be read.
  const std::int64_t bare = event_packet_t{}.getEncodedSize();
  for (const LogEntry& entry : log.entries()) {
    const Utime t = entry.utime + log_to_sensor;
    if (!EndsWith(log.channel(entry), "EVENTS") || t < inputs->begin || t > inputs->end) continue;
    inputs->n_events += std::max<std::int64_t>(0, (entry.size - bare) / 9);
  }
}

std::optional<SE3> StartPose(const RunJob& job, Utime begin) {
  if (job.initial_pose) return job.initial_pose;
  if (job.initial_from.empty()) return std::nullopt;
  const Trajectory truth = ReadTum(job.initial_from);
  // The truth may begin a little later than the log.
  SE3 pose;
  for (Utime t = begin; t < begin + kMicrosPerSecond / 2; t += 1000) {
    if (PoseAt(truth, t, &pose)) return pose;
  }
  throw std::runtime_error(job.initial_from + ": has no pose at the start of the log (" +
                           DecimalSeconds(begin) + " s); are both from the same sequence?");
}

}  // namespace

RunInputs PrepareRun(const RunJob& job) {
  RunInputs inputs;
  LoadRig(job.rig);
  const PipelineOptions options = LoadOptions(job.config);
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
  if (!job.map.empty()) RequireMetres(Summarize(LoadMap(job.map).map), job.map);
  if (!job.photometric_map.empty()) LoadPhotometricMap(job.photometric_map);
  ReadSpan(job, &inputs);
  inputs.start = StartPose(job, inputs.begin);
  ParsePlacePrior(job.place.near, job.place.height, job.place.yaw);
  if (!inputs.start && options.method != PipelineOptions::Method::kEvit) {
    throw std::runtime_error(settings +
                             ": methods EVT and EVPT need a start: give --initial-pose or --initial-from");
  }
  if (!job.truth.empty()) {
    for (const StampedPose& s : ReadTum(job.truth)) {
      if (s.t >= inputs.begin && s.t <= inputs.end) inputs.truth.push_back(s);
    }
    if (inputs.truth.empty()) {
      throw std::runtime_error(job.truth + ": has no pose during the log; are both from the same sequence?");
    }
  }
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
