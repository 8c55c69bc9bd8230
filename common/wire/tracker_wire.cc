#include "common/wire/tracker_wire.h"

#include <algorithm>

#include "common/tracking/feedback.h"
#include "common/wire/geometry_wire.h"
#include "common/wire/imu_wire.h"

namespace evit {

KeyframeInput FromMessage(const keyframe_t& m) {
  KeyframeInput k;
  k.t = m.utime;
  k.seq = m.seq;
  k.n_events = m.n_events;
  k.imu_gap = m.imu_gap_us;
  k.surface = cv::Mat(m.height, m.width, CV_8UC1);
  std::copy(m.surface.begin(), m.surface.end(), k.surface.data);
  k.imu = SamplesOf(m);
  return k;
}

window_state_t ToWindowState(const TrackerOutput& output) {
  window_state_t m{};
  m.mode = static_cast<std::int8_t>(output.mode);
  for (const NodeEstimate& node : output.nodes) {
    node_state_t n{};
    n.utime = node.t;
    n.keyframe_seq = node.seq;
    PutPose(node.state.T_map_body, &n);
    Put(node.state.velocity, n.velocity);
    Put(node.state.bias.gyro, n.gyro_bias);
    Put(node.state.bias.accel, n.accel_bias);
    m.node.push_back(n);
  }
  m.n_nodes = static_cast<std::int32_t>(m.node.size());
  if (!output.nodes.empty()) {
    m.utime = output.nodes.back().t;
    m.keyframe_seq = output.nodes.back().seq;
  }
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) m.covariance[r][c] = output.covariance(r, c);
  }
  m.n_points = output.quality.n_points;
  m.inlier_share = output.quality.inlier_share;
  m.mean_cost = output.quality.mean_value;
  m.n_iterations = output.iterations;
  return m;
}

tracker_mode_t ToTrackerMode(const TrackerOutput& output, Utime t, std::int64_t keyframe_seq) {
  tracker_mode_t m{};
  m.utime = t;
  m.keyframe_seq = keyframe_seq;
  m.reason = output.reason;
  const TrackerFeedback feedback = FeedbackOf(output);
  m.mode = static_cast<std::int8_t>(feedback.mode);
  m.image_speed = feedback.image_speed;
  m.useful_interval_us = feedback.useful_interval;
  m.keyframe_stride = feedback.keyframe_stride;
  return m;
}

body_pose_t ToBodyPose(Utime t, const NavState& state) {
  body_pose_t m{};
  m.utime = t;
  PutPose(state.T_map_body, &m);
  Put(state.velocity, m.velocity);
  return m;
}

}  // namespace evit
