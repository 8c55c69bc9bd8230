#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/geometry/rig.h"

namespace evit {

/// A sequence of the VECtor benchmark on disk, to become an LCM log.
struct SequenceImport {
  std::string folder;  // holds NAME1.synced.left_event.hdf5, .imu.txt and, where known, .gt.txt
  std::string name;    // e.g. "desk_normal"
  std::string out;     // log to write; the truth goes to out + ".truth.tum"
  Rig rig;             // T_marker_body turns the marker body's ground truth into the IMU's
  SE3 T_map_world;     // ground truth's world to the map's frame
  std::optional<std::pair<double, double>> seconds;  // part to take, counted from the first event
};

struct ImportSummary {
  std::int64_t n_events = 0, n_packets = 0, n_imu = 0, n_truth = 0;
  double seconds = 0;
};

/// Writes EVENTS (at most 7,000 events and 5 ms each; an empty packet says "none until here" every 10 ms of
/// silence), IMU (one sample each) and GROUND_TRUTH (body in the map frame) in order of data time; a packet's
/// log time is its last event's, so that a player sends it when it is complete. All files appear whole or not
/// at all. Throws std::runtime_error naming file, field and remedy; an unknown name lists the sequences
/// found.
ImportSummary ImportSequence(const SequenceImport& job, const std::function<void(double)>& progress);

}  // namespace evit
