#pragma once

#include <vector>

#include "common/tracking/synthetic_scene.h"
#include "common/tracking/tracker.h"

namespace evit {

/// Settings for a room of points alone.
inline TrackerOptions TestOptions() {
  TrackerOptions o;
  o.min_events = 1000;
  o.lag_px = 0;
  o.points.per_keyframe = 600;
  o.points.occlusion = false;
  o.window.correlated_share = o.window.map_sigma_m = o.window.stamp_sigma_us = 0;
  o.bootstrap.min_displacement_m = 0.05;
  o.bootstrap.min_rotation_deg = 5;
  o.bootstrap.min_contrast = o.failure.min_contrast = 0.15;
  o.failure.max_coast_s = 0.3;
  o.failure.max_position_sigma_m = 0.2;
  return o;
}

inline Rig TestRig() {
  Rig rig;
  rig.camera = synthetic::VgaCamera();
  rig.T_body_camera = synthetic::BodyCamera();
  rig.imu_noise = {7e-4, 1.3e-3, 7e-6, 6e-5};
  rig.imu_rate_hz = 200;
  return rig;
}

/// Drives a tracker over a synthetic room: the job of frame_builder and map_server.
struct Bench {
  synthetic::Motion motion;
  std::vector<Eigen::Vector3f> room = synthetic::RoomPoints();
  AlignmentSettings settings = synthetic::Alignment();
  ImuBias bias{{0.004, -0.003, 0.002}, {0.03, -0.04, 0.02}};
  Tracker tracker;
  std::int64_t seq = 0;
  Utime last = 0, clock = 0;  // us to add to all stamps

  explicit Bench(const TrackerOptions& options, const SE3& start) : tracker(TestRig(), options, start) {}

  TrackerOutput Step(Utime t, const std::vector<Eigen::Vector3f>& seen_points) {
    const VisibilityQuery query = tracker.NextQuery();
    std::vector<std::int32_t> ids;
    std::vector<Eigen::Vector3f> points;
    const SE3 T = query.T_map_camera.Inverse();
    for (std::size_t k = 0; k < room.size(); ++k) {
      Eigen::Vector2d uv;
      if (!query.camera.Project(T * room[k].cast<double>(), &uv) ||
          !query.camera.Contains(uv, -query.margin_px))
        continue;
      ids.push_back(static_cast<std::int32_t>(k));
      points.push_back(room[k]);
    }
    tracker.AddVisible(ids, points);
    KeyframeInput k;
    k.t = t + clock;
    k.seq = seq++;
    k.n_events = seen_points.empty() ? 100 : 20000;
    k.surface = synthetic::DrawSurface(settings, seen_points, motion.State(ToSeconds(t)).T_map_body);
    if (last > 0) k.imu = motion.Samples(last, t, bias);
    for (ImuSample& s : k.imu) s.t += clock;
    k.imu_gap = 5000;
    last = t;
    return tracker.Process(k);
  }

  /// High-rate frames of the whole room, until it tracks or 2 s have passed. Moves *t, us; the last output.
  TrackerOutput UntilTracking(Utime* t) {
    TrackerOutput out;
    for (const Utime end = *t + 2'000'000; out.mode != TrackerMode::kTracking && *t < end;)
      out = Step(*t += 10'000, room);
    return out;
  }
};

}  // namespace evit
