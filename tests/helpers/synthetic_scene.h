#pragma once

// A room of random edge points, a smooth motion through it with its exact IMU readings, and time surfaces
// drawn from the points.
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "common/imu/imu_sample.h"
#include "common/tracking/event_alignment.h"
#include "common/tracking/state.h"

namespace evit::synthetic {

inline Camera VgaCamera(Camera::Model model = Camera::Model::kPlumbBob) {
  Camera camera;
  camera.model = model;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 327;
  camera.cx = 305;
  camera.cy = 235;
  camera.distortion = model == Camera::Model::kPlumbBob
                          ? std::array<double, 5>{-0.032, 0.042, -5e-4, -1e-3, 0}
                          : std::array<double, 5>{-0.01, 0.02, -0.01, 0.001, 0};
  return camera;
}

/// Camera looking along the body's x axis, 5 cm in front of the IMU.
inline SE3 BodyCamera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(R), {0.05, 0.01, 0.02}};
}

inline AlignmentSettings Alignment(Camera::Model model = Camera::Model::kPlumbBob) {
  AlignmentSettings settings;
  settings.set_camera(VgaCamera(model));
  settings.T_camera_body = BodyCamera().Inverse();
  settings.kernel = {RobustKernel::Kind::kCauchy, 1.0};
  return settings;
}

/// Short line segments of points 1.5 to 4 m in front of a body at the origin (+x), some 50 degrees around.
inline std::vector<Eigen::Vector3f> RoomPoints(int lines = 60, unsigned seed = 1) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < lines; ++k) {
    const double depth = 2.75 + 1.25 * u(rng);
    const Eigen::Vector3d a(depth, 0.9 * depth * u(rng), 0.7 * depth * u(rng));
    const Eigen::Vector3d b = a + 0.5 * Eigen::Vector3d(0.3 * u(rng), u(rng), u(rng));
    for (int i = 0; i < 60; ++i) points.push_back((a + (b - a) * (i / 59.0)).cast<float>());
  }
  return points;
}

/// Hand-held motion: body pose, velocity and exact IMU reading at time t (s).
struct Motion {
  double amplitude = 0.15, turn = 0.15, gravity = 9.81;
  Eigen::Vector3d Position(double t) const {
    return amplitude * Eigen::Vector3d(0.7 * std::sin(1.7 * t), std::sin(2.3 * t), 0.8 * std::sin(1.1 * t));
  }
  Eigen::Quaterniond Rotation(double t) const {
    return ExpSO3(turn * Eigen::Vector3d(std::sin(2.0 * t), std::sin(1.3 * t), std::sin(1.9 * t)));
  }
  BodyState State(double t) const {
    constexpr double h = 1e-4;
    BodyState s;
    s.T_map_body = {Rotation(t), Position(t)};
    s.velocity = (Position(t + h) - Position(t - h)) / (2 * h);
    return s;
  }
  ImuSample Imu(Utime utime, const ImuBias& bias) const {
    const double t = ToSeconds(utime);
    constexpr double h = 1e-3;
    const Eigen::Vector3d a = (Position(t + h) - 2 * Position(t) + Position(t - h)) / (h * h);
    ImuSample s;
    s.t = utime;
    s.gyro = LogSO3(Rotation(t - h).conjugate() * Rotation(t + h)) / (2 * h) + bias.gyro;
    s.accel = Rotation(t).conjugate() * (a + Eigen::Vector3d(0, 0, gravity)) + bias.accel;
    return s;
  }
  /// At 200 Hz, both ends included.
  std::vector<ImuSample> Samples(Utime begin, Utime end, const ImuBias& bias) const {
    std::vector<ImuSample> samples;
    for (Utime t = begin; t < end; t += 5000) samples.push_back(Imu(t, bias));
    samples.push_back(Imu(end, bias));
    return samples;
  }
};

/// Negated time surface as it would be with an event just now under every visible point.
inline cv::Mat DrawSurface(const AlignmentSettings& settings, const std::vector<Eigen::Vector3f>& points,
                           const SE3& T_map_body, double sigma = 1.5) {
  cv::Mat dots(settings.camera().height, settings.camera().width, CV_32FC1, cv::Scalar(0));
  const SE3 T = settings.T_camera_body * T_map_body.Inverse();
  for (const auto& p : points) {
    Eigen::Vector2d uv;
    if (!settings.camera().Project(T * p.cast<double>(), &uv) || !settings.camera().Contains(uv, 1)) continue;
    const int x = static_cast<int>(uv.x()),
              y = static_cast<int>(uv.y());  // bilinear splat keeps sub-pixel positions
    const auto a = static_cast<float>(uv.x() - x), b = static_cast<float>(uv.y() - y);
    dots.at<float>(y, x) += (1 - a) * (1 - b);
    dots.at<float>(y, x + 1) += a * (1 - b);
    dots.at<float>(y + 1, x) += (1 - a) * b;
    dots.at<float>(y + 1, x + 1) += a * b;
  }
  cv::Mat soft, surface;
  cv::GaussianBlur(dots, soft, {0, 0}, sigma);
  cv::Mat(cv::min(soft * 6.0, 1.0)).convertTo(surface, CV_8UC1, -255, 255);
  return surface;
}

}  // namespace evit::synthetic
