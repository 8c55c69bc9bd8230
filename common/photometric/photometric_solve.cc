// The part of PhotometricTracker that finds pose and motion of one frame, coarse to fine.
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/LU>
#include <algorithm>

#include "common/photometric/photometric_factor.h"
#include "common/photometric/photometric_tracker.h"
#include "common/tracking/pose_manifold.h"

namespace evit {
namespace {

// Of one point's squared residual: neighbours share the noise of the same events.
constexpr double kPointWeight = 0.1;
constexpr double kBorder = 4;  // pixels of a level, that points keep from the image's border

// Median speed over the image of (some of) the points, pixels/s.
double ImageSpeed(const PhotometricScene& scene, const SE3& pose, const Twist& twist) {
  constexpr std::size_t kEnough = 200;
  constexpr double kStep = 1e-3;  // s
  const SE3 T = scene.T_camera_body * pose.Inverse();
  const std::size_t stride = std::max<std::size_t>(1, scene.points.size() / kEnough);
  std::vector<double> speeds;
  for (std::size_t k = 0; k < scene.points.size(); k += stride) {
    const Eigen::Vector3d& p = scene.points[k].point;
    const Eigen::Vector3d moved =
        p - kStep * (twist.head<3>() + Eigen::Vector3d(twist.tail<3>()).cross(p - scene.origin));
    Eigen::Vector2d a, b;
    if (scene.camera.Project(T * p, &a) && scene.camera.Project(T * moved, &b))
      speeds.push_back((b - a).norm() / kStep);
  }
  if (speeds.empty()) return 0;
  const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  return *middle;
}

}  // namespace

PhotometricTracker::Solution PhotometricTracker::Solve(const PhotometricFrame& frame,
                                                       const SE3& expected) const {
  const PhotometricOptions& settings = options_.photometric;
  const double seconds = ToSeconds(frame.end - frame.begin);
  const EventImage events(frame.counts, settings.contrast_threshold, settings.blur_sigma_px, settings.levels);
  Solution solution;
  solution.pose = expected;
  solution.origin = expected.p;
  Twist prior;
  prior << state_.velocity, rate_;
  solution.twist = prior;
  Vector6d twist_sigma;
  twist_sigma << Eigen::Vector3d::Constant(settings.sigma_velocity),
      Eigen::Vector3d::Constant(settings.sigma_rate);

  PhotometricScene scene;
  scene.T_camera_body = rig_.T_body_camera.Inverse();
  scene.camera = rig_.camera;
  scene.events = &events;
  scene.origin = solution.origin;
  scene.weight = kPointWeight;
  scene.robust_scale = settings.robust_scale;
  if (view_.log_intensity.empty()) return solution;
  for (int level = settings.levels - 1; level >= 0; --level) {
    scene.level = level;
    scene.points.clear();
    const SE3 T = scene.T_camera_body * expected.Inverse();
    for (const GradientPoint& g : FindGradientPoints(view_, level, settings.blur_sigma_px,
                                                     settings.min_gradient, settings.max_points)) {
      Eigen::Vector2d pixel;
      if (scene.camera.Project(T * g.point, &pixel) && scene.camera.Contains(pixel, kBorder * (2 << level)))
        scene.points.push_back(g);
    }
    if (static_cast<int>(scene.points.size()) < 12) return solution;
    scene.Prepare();
    const TwistFit fit = FitTwist(scene, solution.pose, seconds, prior, twist_sigma);
    if (!(fit.event_rms > 0)) return solution;
    solution.twist = fit.twist;
    scene.event_norm = fit.event_rms;
    MinimizeAt(scene, expected, fit.twist, &solution);
  }
  solution.quality = MeasurePhotometric(scene, solution.pose, solution.twist);
  solution.image_speed = ImageSpeed(scene, solution.pose, solution.twist);
  return solution;
}

void PhotometricTracker::MinimizeAt(const PhotometricScene& scene, const SE3& expected, const Twist& prior,
                                    Solution* solution) const {
  const PhotometricOptions& settings = options_.photometric;
  Vector6d pose_sigma, twist_sigma;
  pose_sigma << Eigen::Vector3d::Constant(settings.sigma_position_m),
      Eigen::Vector3d::Constant(settings.sigma_rotation_rad);
  twist_sigma << Eigen::Vector3d::Constant(settings.sigma_velocity),
      Eigen::Vector3d::Constant(settings.sigma_rate);
  BodyState state;
  state.T_map_body = solution->pose;
  StateBlocks blocks = ToBlocks(state);
  Twist twist = solution->twist;
  ceres::Problem problem;
  problem.AddParameterBlock(blocks.pose.data(), 7, new PoseManifold);
  problem.AddParameterBlock(twist.data(), 6);
  problem.AddResidualBlock(new PhotometricFactor(&scene), nullptr, blocks.pose.data(), twist.data());
  problem.AddResidualBlock(new MotionPriorFactor(expected, prior, pose_sigma, twist_sigma), nullptr,
                           blocks.pose.data(), twist.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  solution->iterations += static_cast<int>(summary.iterations.size());
  if (!summary.IsSolutionUsable()) return;
  solution->pose = PoseFromBlock(blocks.pose.data());
  solution->pose.q.normalize();
  solution->twist = twist;
  if (scene.level > 0) return;
  // What is known of the pose when nothing is known of the motion but its prior.
  Eigen::Matrix<double, 12, 12> H = EvaluatePhotometric(scene, solution->pose, twist, true).hessian;
  H.diagonal().head<6>() += pose_sigma.cwiseAbs2().cwiseInverse();
  H.diagonal().tail<6>() += twist_sigma.cwiseAbs2().cwiseInverse();
  const Matrix6d motion = H.bottomRightCorner<6, 6>(), cross = H.topRightCorner<6, 6>();
  solution->information = H.topLeftCorner<6, 6>() - cross * motion.inverse() * cross.transpose();
}

}  // namespace evit
