#include "common/geometry/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace evit {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// Distortion of the normalised plane, with d(out)/d(in).
void PlumbBob(const std::array<double, 5>& d, const Vec2& m, Vec2* out, Mat2* jacobian) {
  const double k1 = d[0], k2 = d[1], p1 = d[2], p2 = d[3], k3 = d[4];
  const double x = m.x(), y = m.y(), xx = x * x, yy = y * y, xy = x * y, r2 = xx + yy;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  *out = {x * radial + 2 * p1 * xy + p2 * (r2 + 2 * xx), y * radial + p1 * (r2 + 2 * yy) + 2 * p2 * xy};
  if (jacobian != nullptr) {
    const double slope = k1 + r2 * (2 * k2 + r2 * 3 * k3);  // d(radial)/d(r2)
    const double off = 2 * xy * slope + 2 * p1 * x + 2 * p2 * y;
    *jacobian << radial + 2 * xx * slope + 2 * p1 * y + 6 * p2 * x, off, off,
        radial + 2 * yy * slope + 6 * p1 * y + 2 * p2 * x;
  }
}

void Equidistant(const std::array<double, 5>& d, const Vec2& m, Vec2* out, Mat2* jacobian) {
  const double r = m.norm();
  if (r < 1e-8) {
    *out = m;
    if (jacobian != nullptr) jacobian->setIdentity();
    return;
  }
  const double theta = std::atan(r), t2 = theta * theta;
  const double theta_d = theta * (1 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
  const double scale = theta_d / r;
  *out = scale * m;
  if (jacobian != nullptr) {
    const double slope = 1 + t2 * (3 * d[0] + t2 * (5 * d[1] + t2 * (7 * d[2] + t2 * 9 * d[3])));
    const double d_theta_d = slope / (1 + r * r);          // d(theta_d)/dr
    const double d_scale = (d_theta_d - scale) / (r * r);  // d(scale)/dr / r
    *jacobian = scale * Mat2::Identity() + d_scale * m * m.transpose();
  }
}

void Distort(const Camera& camera, const Vec2& m, Vec2* out, Mat2* jacobian) {
  if (camera.model == Camera::Model::kPlumbBob) {
    PlumbBob(camera.distortion, m, out, jacobian);
  } else {
    Equidistant(camera.distortion, m, out, jacobian);
  }
}

// Whether the distortion polynomial grows all the way from the centre to the ray at squared radius r2. Beyond
// the first place where it turns back (it may rise again later) a point outside the view would land in the
// image.
bool InLensRange(const Camera& camera, double r2) {
  const auto& d = camera.distortion;
  std::array<double, 4> k{};  // slope at u: 1 + k0 u + k1 u^2 + k2 u^3 + k3 u^4
  double end = r2;            // plumb_bob: u = r^2; equidistant: u = theta^2
  if (camera.model == Camera::Model::kPlumbBob) {
    if (!(r2 <= 25)) return false;  // a ray at 79 degrees: no such lens has a polynomial that far out
    k = {3 * d[0], 5 * d[1], 7 * d[4], 0};
  } else {
    const double theta = std::atan(std::sqrt(r2));
    k = {3 * d[0], 5 * d[1], 7 * d[2], 9 * d[3]};
    end = theta * theta;
  }
  // Cheap and enough for nearly every point: the negative terms alone never reach -1.
  double lower = 0;
  for (int i = 3; i >= 0; --i) lower = (lower + std::min(k[i], 0.0)) * end;
  if (1 + lower > 0) return true;
  constexpr int kSteps = 32;
  for (int step = kSteps; step > 0; --step) {
    const double u = end * step / kSteps;
    if (1 + u * (k[0] + u * (k[1] + u * (k[2] + u * k[3]))) <= 0) return false;
  }
  return true;
}

}  // namespace

bool Camera::Project(const Eigen::Vector3d& point, Vec2* pixel, Eigen::Matrix<double, 2, 3>* jacobian) const {
  if (!(point.z() > 1e-6)) return false;
  const double iz = 1 / point.z();
  const Vec2 m(point.x() * iz, point.y() * iz);
  if (!InLensRange(*this, m.squaredNorm())) return false;
  Vec2 out;
  Mat2 dm;
  Distort(*this, m, &out, jacobian != nullptr ? &dm : nullptr);
  *pixel = {fx * out.x() + cx, fy * out.y() + cy};
  if (jacobian != nullptr) {
    Eigen::Matrix<double, 2, 3> dp;
    dp << iz, 0, -m.x() * iz, 0, iz, -m.y() * iz;
    *jacobian = Vec2(fx, fy).asDiagonal() * dm * dp;
  }
  return true;
}

bool Camera::Unproject(const Vec2& pixel, Eigen::Vector3d* ray) const {
  const Vec2 target((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Vec2 m = target;
  if (model == Model::kEquidistant) {  // start from the undistorted fisheye angle: far better at the rim
    const double theta = std::min(target.norm(), 1.5);
    if (theta > 1e-8) m = target * (std::tan(theta) / target.norm());
  }
  for (int i = 0; i < 30; ++i) {
    Vec2 out;
    Mat2 jacobian;
    Distort(*this, m, &out, &jacobian);
    const Vec2 error = out - target;
    if (error.squaredNorm() < 1e-24) break;
    const Vec2 step = jacobian.inverse() * error;
    if (!step.allFinite()) return false;
    m -= step;
  }
  Vec2 out;
  Distort(*this, m, &out, nullptr);
  if (!((out - target).squaredNorm() < 1e-16)) return false;
  *ray = {m.x(), m.y(), 1};
  return true;
}

bool CameraModelFromName(const std::string& name, Camera::Model* model) {
  if (name == "plumb_bob" || name == "radtan") {
    *model = Camera::Model::kPlumbBob;
  } else if (name == "equidistant") {
    *model = Camera::Model::kEquidistant;
  } else {
    return false;
  }
  return true;
}

const char* CameraModelName(Camera::Model model) {
  return model == Camera::Model::kPlumbBob ? "plumb_bob" : "equidistant";
}

}  // namespace evit
