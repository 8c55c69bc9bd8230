#pragma once

#include <cstdint>
#include <vector>

#include "evit/body_pose_t.hpp"
#include "evit/keyframe_t.hpp"
#include "evit/window_state_t.hpp"
#include "tools/monitor/frame.h"
#include "tools/monitor/map_store.h"
#include "tools/monitor/surface_overlay.h"

/// Binary frames for the page, which reads them in page/src/frames.ts: little-endian, the kind in the first
/// four bytes, numbers at multiples of their size. Units and frames as in the messages; times are
/// microseconds as doubles, exact up to 2^53.
namespace evit::monitor {

enum class FrameKind : std::uint32_t {
  kPose = 1,
  kTruth = 2,
  kWindow = 3,
  kPicture = 4,
  kMap = 5,
  kHistory = 6
};

/// kind u32, 0 u32, utime f64, position f32[3], orientation f32[4] (x y z w), velocity f32[3].
FramePtr EncodePose(FrameKind kind, const body_pose_t& pose);

/// kind u32, mode u32, utime f64, then f32: position[3], orientation[4], velocity[3], gyro_bias[3],
/// accel_bias[3], covariance[6][6], inlier_share, mean_cost, solve_ms, total_ms, latency_ms (negative: not
/// known), n_points. Of the newest node.
FramePtr EncodeWindow(const window_state_t& window, double latency_ms);

/// kind u32, width u16, height u16, utime f64, n u32, event_rate f32 (events/s; negative: not known),
/// decay_us f32, 0 u32, pixel i16[n][2] (1/16 pixel), residual u8[n] (0 on an edge .. 255 far from any),
/// surface u8[height][width].
FramePtr EncodePicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points);

/// kind u32, generation u32 (a new one: forget the old map), first u32, n u32, capacity u32 (as many points
/// come at most), xyz f32[n][3] (m, map frame).
FramePtr EncodeMap(const MapStore& map, std::size_t first, std::size_t n);

}  // namespace evit::monitor
