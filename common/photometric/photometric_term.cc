#include "common/photometric/photometric_term.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace evit {
namespace {

constexpr double kTiny = 1e-12;  // squared brightness change of a twist that is as good as none

// Event image at a point, and its slope over the tangent (dp, dtheta).
struct Seen {
  bool in_image = false;
  double value = 0;
  Vector6d slope = Vector6d::Zero();
};

class Projector {
 public:
  Projector(const PhotometricScene& scene, const SE3& T_map_body)
      : scene_(scene),
        R_body_map_(T_map_body.R().transpose()),
        R_camera_body_(scene.T_camera_body.R()),
        p_(T_map_body.p) {}

  Seen Look(const Eigen::Vector3d& point, bool derivatives) const {
    Seen seen;
    const Eigen::Vector3d x_body = R_body_map_ * (point - p_);
    const Eigen::Vector3d x_camera = R_camera_body_ * x_body + scene_.T_camera_body.p;
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!scene_.camera.Project(x_camera, &pixel, derivatives ? &jacobian : nullptr)) return seen;
    seen.in_image = scene_.camera.Contains(pixel);
    const EventImage::Sample s = scene_.events->At(scene_.level, pixel.x(), pixel.y());
    seen.value = s.value;
    if (!derivatives) return seen;
    const Eigen::Vector3d g =
        R_camera_body_.transpose() * (jacobian.transpose() * Eigen::Vector2d(s.gx, s.gy));
    seen.slope.head<3>() = -(R_body_map_.transpose() * g);
    seen.slope.tail<3>() = g.cross(x_body);
    return seen;
  }

 private:
  const PhotometricScene& scene_;
  Eigen::Matrix3d R_body_map_, R_camera_body_;
  Eigen::Vector3d p_;
};

}  // namespace

Vector6d PhotometricScene::Change(const GradientPoint& g) const {
  Vector6d a;
  a << g.gradient, (g.point - origin).cross(g.gradient);
  return a;
}

void PhotometricScene::Prepare() {
  change.setZero();
  for (const GradientPoint& g : points) {
    const Vector6d a = Change(g);
    change += a * a.transpose();
  }
  if (!points.empty()) change /= static_cast<double>(points.size());
}

PhotometricTerm EvaluatePhotometric(const PhotometricScene& scene, const SE3& T_map_body, const Twist& twist,
                                    bool derivatives) {
  PhotometricTerm term;
  const Projector projector(scene, T_map_body);
  const Vector6d pull = scene.change * twist;
  const double size = std::sqrt(twist.dot(pull) + kTiny), inverse = 1 / size;
  const double per_event = 1 / scene.event_norm;
  const double c2 = scene.robust_scale * scene.robust_scale;
  Eigen::Matrix<double, 12, 1> J;
  for (const GradientPoint& g : scene.points) {
    const Seen seen = projector.Look(g.point, derivatives);
    const Vector6d a = scene.Change(g);
    const double predicted = a.dot(twist) * inverse;
    const double r = seen.value * per_event - predicted;
    const double s = r * r / c2;
    term.cost += 0.5 * scene.weight * c2 * std::log1p(s);
    if (!derivatives) continue;
    J.head<6>() = per_event * seen.slope;
    J.tail<6>() = (predicted * inverse * inverse) * pull - inverse * a;
    const double w = scene.weight / (1 + s);
    term.gradient += w * r * J;
    term.hessian.selfadjointView<Eigen::Lower>().rankUpdate(J, w);
  }
  term.hessian.triangularView<Eigen::StrictlyUpper>() = term.hessian.transpose();
  return term;
}

TwistFit FitTwist(const PhotometricScene& scene, const SE3& T_map_body, double seconds, const Twist& prior,
                  const Vector6d& sigma) {
  TwistFit fit;
  fit.twist = prior;
  if (scene.points.empty()) return fit;
  const Projector projector(scene, T_map_body);
  Vector6d b = Vector6d::Zero();
  double sum = 0;
  for (const GradientPoint& g : scene.points) {
    const double value = projector.Look(g.point, false).value;
    b += value * seconds * scene.Change(g);
    sum += value * value;
  }
  const auto n = static_cast<double>(scene.points.size());
  fit.event_rms = std::sqrt(sum / n);
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
  const Projector projector(scene, T_map_body);
  double ee = 0, ed = 0, dd = 0;
  for (const GradientPoint& g : scene.points) {
    const Seen seen = projector.Look(g.point, false);
    const double d = scene.Change(g).dot(twist);
    ee += seen.value * seen.value;
    ed += seen.value * d;
    dd += d * d;
    if (seen.in_image) ++quality.n_points;
  }
  if (ee > 0 && dd > 0) quality.correlation = ed / std::sqrt(ee * dd);
  return quality;
}

}  // namespace evit
