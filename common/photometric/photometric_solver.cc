#include "common/photometric/photometric_solver.h"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/LU>
#include <algorithm>

#include "common/photometric/photometric_factor.h"
#include "common/tracking/pose_manifold.h"

namespace evit {
namespace {

// Of one point's squared residual: neighbours share the noise of the same events.
constexpr double kPointWeight = 0.1;
constexpr double kBorder = 4;  // pixels of a level, that points keep from the image's border

constexpr int kUnknowns = 12;

Vector6d Sigma(double linear, double angular) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(linear), Eigen::Vector3d::Constant(angular);
  return sigma;
}

Vector6d TwistSigma(const PhotometricOptions& options) {
  return Sigma(options.sigma_velocity, options.sigma_rate);
}

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

PhotometricSolver::PhotometricSolver(const Rig& rig, const PhotometricOptions& options)
    : T_camera_body_(rig.T_body_camera.Inverse()), camera_(rig.camera), options_(options) {}

PhotometricSolution PhotometricSolver::Solve(const PhotometricFrame& frame, const PhotometricView& view,
                                             const SE3& expected, const Twist& motion) const {
  const double seconds = ToSeconds(frame.end - frame.begin);
  const EventImage events(frame.counts, options_.contrast_threshold, options_.blur_sigma_px, options_.levels);
  PhotometricSolution solution;
  solution.pose = expected;
  solution.origin = expected.p;
  solution.twist = motion;
  PhotometricScene scene;
  scene.T_camera_body = T_camera_body_;
  scene.camera = camera_;
  scene.events = &events;
  scene.origin = solution.origin;
  scene.weight = kPointWeight;
  scene.robust_scale = options_.robust_scale;
  if (view.log_intensity.empty()) return solution;
  for (int level = options_.levels - 1; level >= 0; --level) {
    scene.level = level;
    scene.points = PointsInImage(view, level, expected);
    if (static_cast<int>(scene.points.size()) < kUnknowns) return solution;
    scene.Prepare();
    const TwistFit fit = FitTwist(scene, solution.pose, seconds, motion, TwistSigma(options_));
    if (!(fit.event_rms > 0)) return solution;
    solution.twist = fit.twist;
    scene.event_norm = fit.event_rms;
    MinimizeAt(scene, expected, fit.twist, &solution);
  }
  solution.quality = MeasurePhotometric(scene, solution.pose, solution.twist);
  solution.image_speed = ImageSpeed(scene, solution.pose, solution.twist);
  return solution;
}

std::vector<GradientPoint> PhotometricSolver::PointsInImage(const PhotometricView& view, int level,
                                                            const SE3& expected) const {
  const SE3 T = T_camera_body_ * expected.Inverse();
  std::vector<GradientPoint> points;
  for (const GradientPoint& g :
       FindGradientPoints(view, level, options_.blur_sigma_px, options_.min_gradient, options_.max_points)) {
    Eigen::Vector2d pixel;
    if (camera_.Project(T * g.point, &pixel) && camera_.Contains(pixel, kBorder * (2 << level)))
      points.push_back(g);
  }
  return points;
}

void PhotometricSolver::MinimizeAt(const PhotometricScene& scene, const SE3& expected, const Twist& prior,
                                   PhotometricSolution* solution) const {
  const Vector6d pose_sigma = Sigma(options_.sigma_position_m, options_.sigma_rotation_rad);
  const Vector6d twist_sigma = TwistSigma(options_);
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
  options.max_num_iterations = options_.max_iterations;
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
