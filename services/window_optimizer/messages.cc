#include "services/window_optimizer/messages.h"

#include <algorithm>

namespace evit {
namespace {

void Copy(const Eigen::Vector3d& from, double* to) { std::copy_n(from.data(), 3, to); }
void Copy(const Eigen::Quaterniond& from, double* to) { std::copy_n(from.coeffs().data(), 4, to); }

}  // namespace

KeyframeInput FromMessage(const keyframe_t& m) {
  KeyframeInput k;
  k.t = m.utime;
  k.seq = m.seq;
  k.n_events = m.n_events;
  k.imu_gap = m.imu_gap_us;
  k.surface = cv::Mat(m.height, m.width, CV_8UC1);
  std::copy(m.surface.begin(), m.surface.end(), k.surface.data);
  for (int i = 0; i < m.n_imu; ++i) {
    k.imu.push_back({m.imu_utime[i], Eigen::Vector3d(m.gyro[i].data()), Eigen::Vector3d(m.accel[i].data())});
  }
  return k;
}

map_query_t ToMessage(const VisibilityQuery& q) {
  map_query_t m{};
  Copy(q.T_map_camera.p, m.position);
  Copy(q.T_map_camera.q, m.orientation);
  m.camera.model = CameraModelName(q.camera.model);
  m.camera.width = q.camera.width;
  m.camera.height = q.camera.height;
  m.camera.fx = q.camera.fx;
  m.camera.fy = q.camera.fy;
  m.camera.cx = q.camera.cx;
  m.camera.cy = q.camera.cy;
  std::copy(q.camera.distortion.begin(), q.camera.distortion.end(), m.camera.distortion);
  m.margin_px = q.margin_px;
  m.min_depth = q.min_depth;
  m.max_depth = q.max_depth;
  m.occlusion = q.occlusion ? 1 : 0;
  m.max_points = q.max_points;
  m.seed = static_cast<std::int64_t>(q.seed);
  return m;
}

std::vector<Eigen::Vector3f> PointsOf(const map_points_t& m) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(m.xyz.size());
  for (const auto& p : m.xyz) points.emplace_back(p.data());
  return points;
}

window_state_t ToWindowState(const TrackerOutput& output) {
  window_state_t m{};
  m.mode = static_cast<std::int8_t>(output.mode);
  for (const NodeEstimate& node : output.nodes) {
    node_state_t n{};
    n.utime = node.t;
    n.keyframe_seq = node.seq;
    Copy(node.state.T_map_body.p, n.position);
    Copy(node.state.T_map_body.q, n.orientation);
    Copy(node.state.velocity, n.velocity);
    Copy(node.state.bias.gyro, n.gyro_bias);
    Copy(node.state.bias.accel, n.accel_bias);
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
  m.mode = static_cast<std::int8_t>(output.mode);
  m.reason = output.reason;
  m.image_speed = output.image_speed;
  m.keyframe_stride = 1;
  return m;
}

body_pose_t ToBodyPose(Utime t, const NavState& state) {
  body_pose_t m{};
  m.utime = t;
  Copy(state.T_map_body.p, m.position);
  Copy(state.T_map_body.q, m.orientation);
  Copy(state.velocity, m.velocity);
  return m;
}

}  // namespace evit
