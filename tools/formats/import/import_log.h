#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "common/imu/imu_sample.h"
#include "tools/formats/import/drop_counts.h"
#include "tools/formats/import/event_source.h"

namespace evit::formats {

/// What every source of an import is asked for.
struct ImportTarget {
  std::string out;                                   // log to write; the truth goes to out + ".truth.tum"
  SE3 T_map_world;                                   // ground truth's world to the map's frame
  std::optional<std::pair<double, double>> seconds;  // part to take, counted from the first event
};

/// The streams beside the events, whole.
struct ImportStreams {
  std::vector<ImuSample> imu;
  Trajectory truth;      // body in the map frame; may be empty
  std::string imu_name;  // file or topic, for messages; empty where the recording has no IMU
  DropCounts dropped_imu, dropped_truth;
};

struct ImportSummary {
  std::int64_t n_events = 0, n_packets = 0, n_imu = 0, n_truth = 0;
  double seconds = 0;
  Utime first_event = 0, last_event = 0;  // stamps
  double imu_rate_hz = 0;
  Utime imu_offset = 0;  // us that were added to IMU stamps
  DropCounts dropped_events, dropped_imu, dropped_truth;
};

/// Writes EVENTS (at most 7,000 events and 5 ms each; an empty packet says "none until here" every 10 ms of
/// silence), IMU (one sample each) and GROUND_TRUTH (body in the map frame) in order of data time; a packet's
/// log time is its last event's, so that a player sends it when it is complete. All files appear whole or not
/// at all. Throws std::runtime_error naming file, field and remedy.
ImportSummary ImportLog(const ImportTarget& target, EventSource* events, ImportStreams streams,
                        const std::function<void(double)>& progress);

}  // namespace evit::formats
