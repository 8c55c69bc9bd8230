#pragma once

#include <vector>

#include "common/tracking/synthetic_scene.h"
#include "common/tracking/tracker.h"

namespace evit {

/// Settings for a room of points alone.
inline config::Tracker TestConfig() {
  config::Tracker c;
  auto* k = c.mutable_keyframes();
  k->set_min_events(1000);
  auto* p = c.mutable_points();
  p->set_max_active(5000), p->set_per_keyframe(600), p->set_margin_px(40), p->set_min_depth_m(0.1);
  p->set_max_depth_m(12), p->set_occlusion(false), p->set_seed(1);
  auto* w = c.mutable_window();
  w->set_size(5), w->set_kernel(config::Window::CAUCHY), w->set_first_node(config::Window::PRIOR);
  w->set_image_sigma(80), w->set_robust_scale(80), w->set_max_iterations(12), w->set_imu_noise_factor(2);
  w->set_motion_model(2);
  auto* b = c.mutable_bootstrap();
  b->set_min_frames(10), b->set_min_displacement_m(0.05), b->set_min_rotation_deg(5),
      b->set_max_duration_s(2);
  b->set_max_gyro_bias(0.1), b->set_max_accel_bias(0.6);
  auto* f = c.mutable_failure();
  c.mutable_bootstrap()->set_min_contrast(0.15), f->set_min_contrast(0.15), f->set_max_coast_s(0.3),
      f->set_max_position_sigma_m(0.2), f->set_max_speed(6), f->set_max_gyro_bias(0.2);
  f->set_max_accel_bias(1.5), f->set_max_imu_gap_ms(200);
  return c;
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

  explicit Bench(const config::Tracker& config, const SE3& start) : tracker(TestRig(), config, start) {}

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
