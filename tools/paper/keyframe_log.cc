#include "tools/paper/keyframe_log.h"

#include <stdexcept>

#include "common/bus/codec.h"
#include "common/imu/propagation.h"
#include "common/text/words.h"
#include "common/wire/geometry_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::paper {
KeyframeLog::KeyframeLog(const std::string& path) : log_(path) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t k = 0; k < log_.entries().size(); ++k) {
    const LogEntry& entry = log_.entries()[k];
    if (EndsWith(log_.channel(entry), "WINDOW_STATE")) {
      log_.Read(entry, &bytes);
      window_state_t window;
      if (DecodeChecked(bytes.data(), bytes.size(), &window) && !window.node.empty())
        windows_.push_back(window);
    } else if (EndsWith(log_.channel(entry), "KEYFRAME")) {
      log_.Read(entry, &bytes);
      keyframe_t keyframe;
      if (DecodeChecked(bytes.data(), bytes.size(), &keyframe)) keyframes_[keyframe.seq] = k;
    }
  }
  if (windows_.empty())
    throw std::runtime_error(path + ": contains no window of keyframes: its run never tracked");
}

bool KeyframeLog::Read(std::int64_t seq, RecordedKeyframe* keyframe) const {
  const auto it = keyframes_.find(seq);
  if (it == keyframes_.end()) return false;
  std::vector<std::uint8_t> bytes;
  log_.Read(log_.entries().at(it->second), &bytes);
  keyframe_t message;
  if (!DecodeChecked(bytes.data(), bytes.size(), &message)) return false;
  *keyframe = {message.utime,  message.seq,     message.width,
               message.height, message.surface, SamplesOf(message)};
  return true;
}

BodyState StateOf(const node_state_t& node) {
  BodyState state;
  state.T_map_body = PoseOf(node);
  state.velocity = Eigen::Vector3d(node.velocity);
  state.bias = {Eigen::Vector3d(node.gyro_bias), Eigen::Vector3d(node.accel_bias)};
  return state;
}

SE3 PredictFrom(const window_state_t& before, const RecordedKeyframe& keyframe, int motion_model,
                double gravity) {
  const node_state_t &a = before.node.at(before.node.size() - 2), &b = before.node.back();
  const BodyState older = StateOf(a), newer = StateOf(b);
  if (motion_model == 0) return newer.T_map_body;
  if (motion_model == 1) {
    const double s = ToSeconds(keyframe.t - b.utime) / ToSeconds(b.utime - a.utime);
    const Eigen::Quaterniond turn = older.T_map_body.q.conjugate() * newer.T_map_body.q;
    return {(newer.T_map_body.q * ExpSO3(s * LogSO3(turn))).normalized(),
            newer.T_map_body.p + s * (newer.T_map_body.p - older.T_map_body.p)};
  }
  return PropagateImu({newer.T_map_body, newer.velocity}, keyframe.imu, newer.bias, gravity).T_map_body;
}

double MeanPixelDistance(const Rig& rig, const std::vector<Eigen::Vector3f>& points, const SE3& T_map_body_a,
                         const SE3& T_map_body_b) {
  const SE3 a = (T_map_body_a * rig.T_body_camera).Inverse(),
            b = (T_map_body_b * rig.T_body_camera).Inverse();
  double sum = 0;
  int count = 0;
  for (const Eigen::Vector3f& point : points) {
    Eigen::Vector2d pixel_a, pixel_b;
    if (!rig.camera.Project(a * point.cast<double>(), &pixel_a) || !rig.camera.Contains(pixel_a) ||
        !rig.camera.Project(b * point.cast<double>(), &pixel_b))
      continue;
    sum += (pixel_a - pixel_b).norm();
    ++count;
  }
  return count == 0 ? 0 : sum / count;
}

}  // namespace evit::paper
