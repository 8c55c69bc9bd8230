#pragma once

#include <memory>
#include <numeric>
#include <vector>

#include "common/tracking/map_tracker.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {

/// Settings for a room of points alone.
inline TrackerOptions TestOptions() {
  TrackerOptions o;
  o.min_events = 1000;
  o.lag_px = 0;
  o.points.per_keyframe = 600;
  o.window.image_sigma = 80;
  o.points.occlusion = false;
  o.window.correlated_share = o.window.misfit_share = o.window.map_sigma_m = o.window.stamp_sigma_us = 0;
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

/// Keyframes of a synthetic room: the job of frame_builder.
struct KeyframeSource {
  synthetic::Motion motion;
  std::vector<Eigen::Vector3f> room = synthetic::RoomPoints();
  AlignmentSettings settings = synthetic::Alignment();
  ImuBias bias{{0.004, -0.003, 0.002}, {0.03, -0.04, 0.02}};
  std::int64_t seq = 0;
  Utime last = 0, clock = 0;  // us to add to all stamps

  /// At `t`, with events under these points.
  KeyframeInput Next(Utime t, const std::vector<Eigen::Vector3f>& seen_points) {
    KeyframeInput k;
    k.t = t + clock;
    k.seq = seq++;
    k.n_events = seen_points.empty() ? 0 : 20000;
    k.surface = synthetic::DrawSurface(settings, seen_points, motion.State(ToSeconds(t)).T_map_body);
    if (last > 0) k.imu = motion.Samples(last, t, bias);
    for (ImuSample& s : k.imu) s.t += clock;
    k.imu_gap = 5000;
    last = t;
    return k;
  }
  std::vector<std::int32_t> Ids() const {
    std::vector<std::int32_t> ids(room.size());
    std::iota(ids.begin(), ids.end(), 0);
    return ids;
  }
  SE3 Truth(Utime t) const { return motion.State(ToSeconds(t)).T_map_body; }
};

/// Drives a tracker over it, and plays map_server.
struct Bench : KeyframeSource {
  std::unique_ptr<MapTracker> tracker;

  Bench(const TrackerOptions& options, const SE3& start, const Rig& rig = TestRig())
      : tracker(MakeTracker(rig, options, start)) {}

  TrackerOutput Step(Utime t, const std::vector<Eigen::Vector3f>& seen_points) {
    const VisibilityQuery query = tracker->NextQuery();
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
    tracker->AddVisible(ids, points);
    return tracker->Process(Next(t, seen_points));
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
