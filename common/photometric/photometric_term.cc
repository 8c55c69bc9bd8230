#include "common/photometric/photometric_term.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace evit {
namespace {

constexpr double kTiny = 1e-12;  // squared brightness change of a twist that is as good as none

AlignmentSettings SettingsOf(const PhotometricScene& scene) {
  AlignmentSettings settings;
  settings.T_camera_body = scene.T_camera_body;
  settings.set_camera(scene.camera);
  return settings;
}

PhotometricMotion MotionOf(const PhotometricScene& scene, const Twist& twist) {
  const Vector6d pull = scene.change * twist;
  PhotometricMotion motion{};
  for (std::size_t i = 0; i < 6; ++i) {
    motion.twist[i] = static_cast<float>(twist[static_cast<int>(i)]);
    motion.pull[i] = static_cast<float>(pull[static_cast<int>(i)]);
  }
  motion.per_event = static_cast<float>(1 / scene.event_norm);
  motion.per_size = static_cast<float>(1 / std::sqrt(twist.dot(pull) + kTiny));
  return motion;
}

}  // namespace

Vector6d PhotometricScene::Change(const GradientPoint& g) const {
  Vector6d a;
  a << g.gradient, (g.point - origin).cross(g.gradient);
  return a;
}

void PhotometricScene::Prepare() {
  seen_by = SettingsOf(*this);
  change.setZero();
  std::vector<Eigen::Vector3f> places;
  places.reserve(points.size());
  for (std::vector<float>& c : arrays.change) c.assign(points.size() + kLanes, 0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vector6d a = Change(points[k]);
    change += a * a.transpose();
    for (std::size_t i = 0; i < 6; ++i) arrays.change[i][k] = static_cast<float>(a[static_cast<int>(i)]);
    places.emplace_back(points[k].point.cast<float>());
  }
  if (!points.empty()) change /= static_cast<double>(points.size());
  arrays.place = AlignmentPoints(places);
}

PhotometricTerm EvaluatePhotometric(const PhotometricScene& scene, const SE3& T_map_body, const Twist& twist,
                                    bool derivatives) {
  PhotometricTerm term;
  PhotometricSums sums;
  const PhotometricBatch batch(scene.seen_by, scene.arrays, T_map_body, *scene.events, scene.level);
  const LaneKernel kernel({RobustKernel::Kind::kCauchy, scene.robust_scale});
  SumPhotometric(batch, scene.arrays, MotionOf(scene, twist), kernel, derivatives, &sums);
  term.cost = 0.5 * scene.weight * sums.rho;
  if (!derivatives) return term;
  const float(*cell)[kLanes] = sums.hessian;
  for (int i = 0; i < 12; ++i) {
    term.gradient[i] = scene.weight * SumLanes(sums.gradient[i]);
    for (int j = i; j < 12; ++j) term.hessian(i, j) = term.hessian(j, i) = scene.weight * SumLanes(*cell++);
  }
  // Positions: from the body frame to the map's.
  const Eigen::Matrix3d R = T_map_body.R();
  term.gradient.head<3>() = (R * term.gradient.head<3>()).eval();
  term.hessian.topRows<3>() = (R * term.hessian.topRows<3>()).eval();
  term.hessian.leftCols<3>() = (term.hessian.leftCols<3>() * R.transpose()).eval();
  return term;
}

TwistFit FitTwist(const PhotometricScene& scene, const SE3& T_map_body, double seconds, const Twist& prior,
                  const Vector6d& sigma) {
  TwistFit fit;
  fit.twist = prior;
  if (scene.points.empty()) return fit;
  const EventSums sums = SumEvents(
      PhotometricBatch(scene.seen_by, scene.arrays, T_map_body, *scene.events, scene.level), scene.arrays);
  const Vector6d b = seconds * Eigen::Map<const Vector6d>(sums.by_change.data());
  const auto n = static_cast<double>(scene.points.size());
  fit.event_rms = std::sqrt(sums.squared / n);
  if (!(fit.event_rms > 0)) return fit;
  const double per_point = scene.weight / (fit.event_rms * fit.event_rms);
  const Matrix6d information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  const Matrix6d A = per_point * n * seconds * seconds * scene.change + information;
  fit.twist = A.ldlt().solve(per_point * b + information * prior);
  return fit;
}

PhotometricQuality MeasurePhotometric(const PhotometricScene& scene, const SE3& T_map_body,
                                      const Twist& twist) {
  PhotometricQuality quality;
  const EventSums sums = SumEvents(
      PhotometricBatch(scene.seen_by, scene.arrays, T_map_body, *scene.events, scene.level), scene.arrays);
  const double both = Eigen::Map<const Vector6d>(sums.by_change.data()).dot(twist);
  const double predicted = static_cast<double>(scene.points.size()) * twist.dot(scene.change * twist);
  quality.n_points = sums.in_image;
  if (sums.squared > 0 && predicted > 0) quality.correlation = both / std::sqrt(sums.squared * predicted);
  return quality;
}

}  // namespace evit
