#include "tools/monitor/page_frames.h"

#include <algorithm>
#include <cmath>

namespace evit::monitor {
namespace {

std::shared_ptr<Frame> Begin(FrameKind kind) {
  auto frame = std::make_shared<Frame>(false);
  frame->Append(static_cast<std::uint32_t>(kind));
  return frame;
}

void AppendFloats(const double* values, std::size_t n, Frame* frame) {
  for (std::size_t i = 0; i < n; ++i) frame->Append(static_cast<float>(values[i]));
}

template <typename Message>
void AppendMotion(const Message& m, Frame* frame) {
  AppendFloats(m.position, 3, frame);
  AppendFloats(m.orientation, 4, frame);
  AppendFloats(m.velocity, 3, frame);
}

}  // namespace

FramePtr EncodePose(FrameKind kind, const body_pose_t& pose) {
  const auto frame = Begin(kind);
  frame->Append(std::uint32_t{0});
  frame->Append(static_cast<double>(pose.utime));
  AppendMotion(pose, frame.get());
  return frame;
}

FramePtr EncodeWindow(const window_state_t& window, double latency_ms) {
  const auto frame = Begin(FrameKind::kWindow);
  frame->Append(static_cast<std::uint32_t>(window.mode));
  frame->Append(static_cast<double>(window.utime));
  const node_state_t node = window.node.empty() ? node_state_t{} : window.node.back();
  AppendMotion(node, frame.get());
  AppendFloats(node.gyro_bias, 3, frame.get());
  AppendFloats(node.accel_bias, 3, frame.get());
  AppendFloats(&window.covariance[0][0], 36, frame.get());
  const double figures[] = {window.inlier_share, window.mean_cost, window.solve_ms,
                            window.total_ms,     latency_ms,       static_cast<double>(window.n_points)};
  AppendFloats(figures, std::size(figures), frame.get());
  return frame;
}

FramePtr EncodePicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points) {
  const auto frame = Begin(FrameKind::kPicture);
  const auto size = static_cast<std::size_t>(keyframe.surface_size);
  frame->Reserve(64 + 5 * points.size() + size);
  frame->Append(static_cast<std::uint16_t>(keyframe.width));
  frame->Append(static_cast<std::uint16_t>(keyframe.height));
  frame->Append(static_cast<double>(keyframe.utime));
  frame->Append(static_cast<std::uint32_t>(points.size()));
  const auto interval = static_cast<float>(keyframe.utime - keyframe.previous_utime);
  frame->Append(interval > 0 ? 1e6F * static_cast<float>(keyframe.n_events) / interval : -1.0F);
  frame->Append(static_cast<float>(keyframe.decay_us));
  frame->Append(std::uint32_t{0});
  const auto sixteenths = [](float pixel) {
    return static_cast<std::int16_t>(std::lround(std::clamp(16 * pixel, -32768.0F, 32767.0F)));
  };
  for (const OverlayPoint& point : points) {
    frame->Append(sixteenths(point.x));
    frame->Append(sixteenths(point.y));
  }
  for (const OverlayPoint& point : points) frame->Append(point.residual);
  frame->Append(keyframe.surface.data(), size);
  return frame;
}

FramePtr EncodeMap(const MapStore& map, std::size_t first, std::size_t n) {
  const auto frame = Begin(FrameKind::kMap);
  frame->Reserve(20 + 12 * n);
  frame->Append(map.generation());
  frame->Append(static_cast<std::uint32_t>(first));
  frame->Append(static_cast<std::uint32_t>(n));
  frame->Append(static_cast<std::uint32_t>(map.capacity()));
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  if (n > 0) frame->Append(map.points()[first].data(), 3 * n);
  return frame;
}

}  // namespace evit::monitor
