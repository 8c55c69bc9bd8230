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
  double accel_scale = 1, gyro_scale = 1;            // from the source's units to m/s^2 and rad/s
  bool any_imu = false;                              // take the IMU even where its units look wrong
};

/// The streams beside the events, whole.
struct ImportStreams {
  std::vector<ImuSample> imu;
  Trajectory truth;        // body in the map frame; may be empty
  std::string imu_name;    // file or topic, for messages; empty where the recording has no IMU
  std::string truth_name;  // the same of the truth
  DropCounts dropped_imu, dropped_truth;
};

struct ImportSummary {
  std::int64_t n_events = 0, n_packets = 0, n_imu = 0, n_truth = 0;
  double seconds = 0;
  Utime first_event = 0, last_event = 0;  // stamps
  double imu_rate_hz = 0;
  double imu_covers_s = 0;  // of the events' time
  Utime imu_offset = 0;     // us that were added to IMU stamps
  DropCounts dropped_events, dropped_imu, dropped_truth;
};

/// Writes EVENTS (at most 7,000 events and 5 ms each; an empty packet says "none until here" every 10 ms of
/// silence), IMU (one sample each) and GROUND_TRUTH (body in the map frame) in order of data time; a packet's
/// log time is its last event's, so that a player sends it when it is complete. All files appear whole or not
/// at all.
///
/// What every source is held to: disorder of up to 50 ms is sorted, what is later or far ahead is dropped and
/// counted (TimeOrder), more than a twentieth of a stream dropped is an error, and so is an IMU whose units
/// look wrong (ImuComplaint). Throws std::runtime_error naming file, field and remedy.
ImportSummary ImportLog(const ImportTarget& target, EventSource* events, ImportStreams streams,
                        const std::function<void(double)>& progress);

}  // namespace evit::formats
