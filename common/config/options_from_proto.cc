#include "common/config/config.h"

namespace evit {

PipelineOptions LoadOptions(const std::string& path) { return ToOptions(LoadTracker(path)); }

PipelineOptions ToOptions(const config::Tracker& m) {
  PipelineOptions o;
  o.method = static_cast<PipelineOptions::Method>(m.method());
  o.keyframes.n_event = m.keyframes().n_event();
  o.keyframes.n_imu = m.keyframes().n_imu();
  o.keyframes.max_interval_ms = m.keyframes().max_interval_ms();
  o.keyframes.min_events = m.keyframes().min_events();
  o.keyframes.fixed_rate_hz = m.keyframes().fixed_rate_hz();
  o.keyframes.bootstrap_interval_ms = m.keyframes().bootstrap_interval_ms();
  o.surface.kind = static_cast<SurfaceOptions::Kind>(m.surface().kind());
  o.surface.lookahead_ms = m.surface().lookahead_ms();
  o.surface.tail_px = m.surface().tail_px();
  o.surface.min_decay_ms = m.surface().min_decay_ms();
  o.surface.max_decay_ms = m.surface().max_decay_ms();
  o.surface.default_decay_ms = m.surface().default_decay_ms();
  o.surface.truncation = m.surface().truncation();
  o.surface.blur_sigma_px = m.surface().blur_sigma_px();
  o.surface.split_polarity = m.surface().split_polarity();
  o.surface.support_filter = m.surface().support_filter();
  o.surface.lag_px = m.surface().lag_px();
  o.surface.hot_pixel_rate_hz = m.surface().hot_pixel_rate_hz();
  o.points.max_active = m.points().max_active();
  o.points.per_keyframe = m.points().per_keyframe();
  o.points.margin_px = m.points().margin_px();
  o.points.min_depth_m = m.points().min_depth_m();
  o.points.max_depth_m = m.points().max_depth_m();
  o.points.occlusion = m.points().occlusion();
  o.points.seed = m.points().seed();
  o.window.size = m.window().size();
  o.window.kernel = static_cast<RobustKernel::Kind>(m.window().kernel());
  o.window.first_node = static_cast<WindowOptions::FirstNode>(m.window().first_node());
  o.window.image_sigma = m.window().image_sigma();
  o.window.robust_scale = m.window().robust_scale();
  o.window.max_iterations = m.window().max_iterations();
  o.window.imu_noise_factor = m.window().imu_noise_factor();
  o.window.motion_model = static_cast<WindowOptions::MotionModel>(m.window().motion_model());
  o.window.correlated_share = m.window().correlated_share();
  o.window.map_sigma_m = m.window().map_sigma_m();
  o.window.stamp_sigma_us = m.window().stamp_sigma_us();
  o.bootstrap.min_frames = m.bootstrap().min_frames();
  o.bootstrap.min_displacement_m = m.bootstrap().min_displacement_m();
  o.bootstrap.min_rotation_deg = m.bootstrap().min_rotation_deg();
  o.bootstrap.max_duration_s = m.bootstrap().max_duration_s();
  o.bootstrap.max_gyro_bias = m.bootstrap().max_gyro_bias();
  o.bootstrap.max_accel_bias = m.bootstrap().max_accel_bias();
  o.bootstrap.min_contrast = m.bootstrap().min_contrast();
  o.failure.min_contrast = m.failure().min_contrast();
  o.failure.max_coast_s = m.failure().max_coast_s();
  o.failure.max_position_sigma_m = m.failure().max_position_sigma_m();
  o.failure.max_speed = m.failure().max_speed();
  o.failure.max_gyro_bias = m.failure().max_gyro_bias();
  o.failure.max_accel_bias = m.failure().max_accel_bias();
  o.failure.max_imu_gap_ms = m.failure().max_imu_gap_ms();
  if (m.has_photometric()) {
    o.photometric.contrast_threshold = m.photometric().contrast_threshold();
    o.photometric.view_margin = m.photometric().view_margin();
    o.photometric.blur_sigma_px = m.photometric().blur_sigma_px();
    o.photometric.levels = m.photometric().levels();
    o.photometric.max_points = m.photometric().max_points();
    o.photometric.min_gradient = m.photometric().min_gradient();
    o.photometric.robust_scale = m.photometric().robust_scale();
    o.photometric.max_iterations = m.photometric().max_iterations();
    o.photometric.sigma_position_m = m.photometric().sigma_position_m();
    o.photometric.sigma_rotation_rad = m.photometric().sigma_rotation_rad();
    o.photometric.sigma_velocity = m.photometric().sigma_velocity();
    o.photometric.sigma_rate = m.photometric().sigma_rate();
    o.photometric.min_correlation = m.photometric().min_correlation();
    o.photometric.max_bad_s = m.photometric().max_bad_s();
  }
  return o;
}

}  // namespace evit
