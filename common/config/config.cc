#include "common/config/config.h"

#include <Eigen/LU>
#include <cmath>

#include "common/config/text_file.h"

namespace evit {
namespace {

template <typename Message>
Message Parse(const std::string& path) {
  Message message;
  ParseTextFile(path, "common/config/*.proto", &message);
  return message;
}

void Require(bool condition, const std::string& path, const std::string& what) {
  if (!condition) throw ConfigError(path + ": " + what);
}

SE3 ToSE3(const config::Transform& t, const std::string& path, const std::string& field) {
  Require(t.m_size() == 16, path,
          field + ".m: 16 numbers are wanted (4x4, row-major), got " + std::to_string(t.m_size()));
  const Eigen::Matrix4d m = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(t.m().data());
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  Require(
      m.allFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
          std::abs(R.determinant() - 1) < 1e-3,
      path,
      field + ".m: the upper left 3x3 is not a rotation (rows of length 1, at right angles, right-handed)");
  Require((m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-9, path,
          field + ".m: the last row must be 0 0 0 1");
  return SE3(m);
}

Camera ToCamera(const config::Camera& c, const std::string& path) {
  Camera camera;
  Require(CameraModelFromName(c.model(), &camera.model), path,
          "camera.model: \"" + c.model() + "\" is not known; use \"plumb_bob\" or \"equidistant\"");
  Require(c.width() >= 16 && c.width() <= 8192 && c.height() >= 16 && c.height() <= 8192, path,
          "camera.width, camera.height: 16 to 8192 pixels are wanted");
  Require(c.fx() > 0 && c.fy() > 0 && std::isfinite(c.fx()) && std::isfinite(c.fy()), path,
          "camera.fx, camera.fy: must be positive");
  Require(c.cx() >= 0 && c.cx() <= c.width() && c.cy() >= 0 && c.cy() <= c.height(), path,
          "camera.cx, camera.cy: must lie in the image (pixels, not normalised)");
  Require(c.distortion_size() == 4 || c.distortion_size() == 5, path,
          "camera.distortion: 4 or 5 numbers are wanted");
  camera.width = c.width();
  camera.height = c.height();
  camera.fx = c.fx();
  camera.fy = c.fy();
  camera.cx = c.cx();
  camera.cy = c.cy();
  for (int k = 0; k < c.distortion_size(); ++k) {
    Require(std::isfinite(c.distortion(k)), path, "camera.distortion: must be finite");
    camera.distortion[k] = c.distortion(k);
  }
  return camera;
}

}  // namespace

Rig LoadRig(const std::string& path) {
  const auto message = Parse<config::Rig>(path);
  Rig rig;
  rig.camera = ToCamera(message.camera(), path);
  rig.camera_time_offset = std::llround(message.camera().time_offset_us());
  rig.T_body_camera = ToSE3(message.t_body_camera(), path, "T_body_camera");
  if (message.has_t_marker_body()) rig.T_marker_body = ToSE3(message.t_marker_body(), path, "T_marker_body");
  const config::Imu& imu = message.imu();
  Require(imu.rate_hz() >= 50 && imu.rate_hz() <= 10'000, path, "imu.rate_hz: 50 to 10000 are wanted");
  rig.imu_rate_hz = imu.rate_hz();
  rig.imu_noise = {imu.gyro_noise_density(), imu.accel_noise_density(), imu.gyro_random_walk(),
                   imu.accel_random_walk()};
  if (imu.has_gyro_range()) rig.imu_noise.gyro_range = imu.gyro_range();
  if (imu.has_accel_range()) rig.imu_noise.accel_range = imu.accel_range();
  Require(rig.imu_noise.gyro_range > 0 && rig.imu_noise.accel_range > 9.81, path,
          "imu.gyro_range, imu.accel_range: full scale in rad/s and m/s^2 is wanted, the latter above 9.81");
  for (const double v : {imu.gyro_noise_density(), imu.accel_noise_density(), imu.gyro_random_walk(),
                         imu.accel_random_walk()}) {
    Require(v > 0 && v < 10, path,
            "imu noise densities and random walks: must be positive (see the units in rig.proto)");
  }
  Require(message.gravity() > 9 && message.gravity() < 10.5, path, "gravity: about 9.81 m/s^2 is wanted");
  rig.gravity = message.gravity();
  return rig;
}

std::string LoadRigName(const std::string& path) { return Parse<config::Rig>(path).name(); }

namespace {

void CheckPhotometric(const config::Photometric& p, const std::string& path) {
  const auto positive = [&](double v, const char* name) {
    Require(v > 0 && std::isfinite(v), path, std::string("photometric.") + name + ": must be positive");
  };
  positive(p.contrast_threshold(), "contrast_threshold");
  positive(p.min_gradient(), "min_gradient");
  positive(p.robust_scale(), "robust_scale");
  positive(p.max_iterations(), "max_iterations");
  positive(p.sigma_position_m(), "sigma_position_m");
  positive(p.sigma_rotation_rad(), "sigma_rotation_rad");
  positive(p.sigma_velocity(), "sigma_velocity");
  positive(p.sigma_rate(), "sigma_rate");
  positive(p.max_bad_s(), "max_bad_s");
  Require(p.view_margin() >= 0 && p.view_margin() <= 1, path, "photometric.view_margin: 0 to 1 is wanted");
  Require(p.blur_sigma_px() >= 0 && p.blur_sigma_px() <= 10, path,
          "photometric.blur_sigma_px: 0 to 10 pixels are wanted");
  Require(p.levels() >= 1 && p.levels() <= 4, path, "photometric.levels: 1 to 4 are wanted");
  Require(p.max_points() >= 100 && p.max_points() <= 100'000, path,
          "photometric.max_points: 100 to 100000 are wanted");
  Require(p.min_correlation() >= 0 && p.min_correlation() < 1, path,
          "photometric.min_correlation: 0 to 1 is wanted");
}

}  // namespace

config::Tracker LoadTracker(const std::string& path) {
  auto c = Parse<config::Tracker>(path);
  const auto positive = [&](double v, const char* name) {
    Require(v > 0 && std::isfinite(v), path, std::string(name) + ": must be positive");
  };
  positive(c.keyframes().n_event(), "keyframes.n_event");
  positive(c.keyframes().n_imu(), "keyframes.n_imu");
  positive(c.keyframes().max_interval_ms(), "keyframes.max_interval_ms");
  positive(c.keyframes().bootstrap_interval_ms(), "keyframes.bootstrap_interval_ms");
  Require(c.keyframes().min_events() >= 0, path, "keyframes.min_events: must not be negative");
  Require(c.keyframes().fixed_rate_hz() >= 0 && c.keyframes().fixed_rate_hz() <= 2000, path,
          "keyframes.fixed_rate_hz: 0 to 2000 are wanted");
  const config::Surface& s = c.surface();
  Require(s.lookahead_ms() >= 0 && s.lookahead_ms() <= 200, path,
          "surface.lookahead_ms: 0 to 200 are wanted");
  positive(s.tail_px(), "surface.tail_px");
  positive(s.min_decay_ms(), "surface.min_decay_ms");
  Require(s.min_decay_ms() <= s.default_decay_ms() && s.default_decay_ms() <= s.max_decay_ms(), path,
          "surface: min_decay_ms <= default_decay_ms <= max_decay_ms is wanted");
  Require(s.truncation() >= 0 && s.truncation() < 255, path,
          "surface.truncation: 0 to 254 grey levels are wanted");
  Require(s.blur_sigma_px() >= 0 && s.blur_sigma_px() <= 20, path,
          "surface.blur_sigma_px: 0 to 20 are wanted");
  Require(s.lag_px() >= 0 && s.lag_px() <= 5, path, "surface.lag_px: 0 to 5 are wanted");
  const config::Points& p = c.points();
  Require(p.max_active() >= 100 && p.max_active() <= 20'000, path,
          "points.max_active: 100 to 20000 are wanted");
  Require(p.per_keyframe() >= 50 && p.per_keyframe() <= 20'000, path,
          "points.per_keyframe: 50 to 20000 are wanted");
  Require(p.margin_px() >= 0, path, "points.margin_px: must not be negative");
  Require(p.min_depth_m() > 0 && p.min_depth_m() < p.max_depth_m(), path,
          "points: 0 < min_depth_m < max_depth_m is wanted");
  const config::Window& w = c.window();
  Require(w.size() >= 2 && w.size() <= 50, path, "window.size: 2 to 50 keyframes are wanted");
  positive(w.image_sigma(), "window.image_sigma");
  positive(w.robust_scale(), "window.robust_scale");
  positive(w.max_iterations(), "window.max_iterations");
  positive(w.imu_noise_factor(), "window.imu_noise_factor");
  Require(w.motion_model() >= 0 && w.motion_model() <= 2, path, "window.motion_model: 0, 1 or 2 is wanted");
  const auto not_negative = [&](double v, const char* name) {
    Require(v >= 0 && std::isfinite(v), path, std::string(name) + ": must not be negative");
  };
  not_negative(w.correlated_share(), "window.correlated_share");
  not_negative(w.map_sigma_m(), "window.map_sigma_m");
  not_negative(w.stamp_sigma_us(), "window.stamp_sigma_us");
  positive(c.bootstrap().min_frames(), "bootstrap.min_frames");
  positive(c.bootstrap().max_duration_s(), "bootstrap.max_duration_s");
  positive(c.bootstrap().max_gyro_bias(), "bootstrap.max_gyro_bias");
  positive(c.bootstrap().max_accel_bias(), "bootstrap.max_accel_bias");
  Require(c.bootstrap().min_contrast() >= 0 && c.bootstrap().min_contrast() < 1, path,
          "bootstrap.min_contrast: 0 to 1 is wanted");
  Require(c.failure().min_contrast() >= 0 && c.failure().min_contrast() < 1, path,
          "failure.min_contrast: 0 to 1 is wanted");
  positive(c.failure().max_coast_s(), "failure.max_coast_s");
  positive(c.failure().max_position_sigma_m(), "failure.max_position_sigma_m");
  positive(c.failure().max_speed(), "failure.max_speed");
  positive(c.failure().max_imu_gap_ms(), "failure.max_imu_gap_ms");
  Require(c.method() != config::Tracker::EVPT || c.has_photometric(), path,
          "photometric: method EVPT wants it, see config/evpt.textproto");
  if (c.has_photometric()) CheckPhotometric(c.photometric(), path);
  return c;
}

}  // namespace evit
