#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/bus/log_file.h"
#include "common/geometry/rig.h"
#include "common/imu/imu_sample.h"
#include "common/tracking/state.h"
#include "evit/window_state_t.hpp"

namespace evit::paper {

/// A keyframe as it was recorded.
struct RecordedKeyframe {
  Utime t = 0;
  std::int64_t seq = 0;
  int width = 0, height = 0;          // pixels
  std::vector<std::uint8_t> surface;  // row-major, 0 (event just now) .. 255 (none)
  std::vector<ImuSample> imu;         // since the previous keyframe, both ends included
};

/// KEYFRAME and WINDOW_STATE messages of a run (`evit run --record`).
class KeyframeLog {
 public:
  /// Throws std::runtime_error naming the file where it cannot be read or holds no window.
  explicit KeyframeLog(const std::string& path);

  const std::vector<window_state_t>& windows() const { return windows_; }
  bool Has(std::int64_t seq) const { return keyframes_.count(seq) == 1; }
  /// By its number; reads it from the file. False where it was not recorded.
  bool Read(std::int64_t seq, RecordedKeyframe* keyframe) const;

 private:
  LogReader log_;
  std::vector<window_state_t> windows_;
  std::map<std::int64_t, std::size_t> keyframes_;  // entry of the log
};

/// The state of a window's node.
BodyState StateOf(const node_state_t& node);

/// Where the three motion models (0 previous pose, 1 constant velocity, 2 IMU) expect the body at `keyframe`,
/// from the window that was there before it (its newest node is the keyframe before). T_map_body. Requires
/// two nodes.
SE3 PredictFrom(const window_state_t& before, const RecordedKeyframe& keyframe, int motion_model,
                double gravity);

/// Mean distance in the image between `points` (map frame) seen from two poses, pixels; 0 where none is in
/// view of both.
double MeanPixelDistance(const Rig& rig, const std::vector<Eigen::Vector3f>& points, const SE3& T_map_body_a,
                         const SE3& T_map_body_b);

}  // namespace evit::paper
