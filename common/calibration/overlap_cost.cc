#include "common/calibration/overlap_cost.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evit {
namespace {

constexpr Utime kAround = 5'000;  // us: half of the time over which the body's velocity is taken
constexpr double kSlow = 5;       // pixels/s: as in CompensateEventLag
constexpr double kWide = 4;       // blurs: how far around the density is taken

cv::Mat Field(const PixelSet& fired, double blur_px) {
  cv::Mat dots(fired.height(), fired.width(), CV_32FC1, cv::Scalar(0));
  for (int y = 0; y < fired.height(); ++y) {
    for (int x = 0; x < fired.width(); ++x) {
      if (fired.Has(x, y)) dots.at<float>(y, x) = 1;
    }
  }
  cv::Mat soft, wide, field;
  cv::GaussianBlur(dots, soft, {0, 0}, blur_px);
  cv::GaussianBlur(dots, wide, {0, 0}, kWide * blur_px);
  soft -= wide;
  double most = 0;
  cv::minMaxLoc(soft, nullptr, &most);
  soft.convertTo(field, CV_8UC1, most > 0 ? -255 / most : 0, 255);
  return field;
}

}  // namespace

OverlapCost::OverlapCost(const std::vector<MapView>* views, const Trajectory* body, const Camera& camera,
                         double blur_px)
    : views_(views), body_(body) {
  settings_.set_camera(camera);
  settings_.T_camera_body = SE3();
  settings_.kernel = {RobustKernel::Kind::kCauchy, 1};
  for (const MapView& view : *views) {
    fields_.emplace_back(Field(view.fired, blur_px), 1);
    points_.emplace_back(view.points);
  }
}

bool OverlapCost::BodyAt(std::size_t view, const Values& values, Utime shift, SE3* T_map_body) const {
  const MapView& v = (*views_)[view];
  // Microseconds are coarse beside a solver's steps; the rest is moved along a line.
  const double late = values.offset - values.lag_px / (v.speed_px + kSlow);
  const double t = 1e6 * late + static_cast<double>(v.begin + (v.end - v.begin) / 2 + shift);
  const auto whole = static_cast<Utime>(std::floor(t));
  SE3 a, b;
  if (!PoseAt(*body_, whole, &a) || !PoseAt(*body_, whole + 1'000, &b)) return false;
  *T_map_body = Interpolate(a, b, (t - static_cast<double>(whole)) / 1'000);
  return true;
}

OverlapCost::Term OverlapCost::Of(std::size_t view, const Values& values) const {
  Term term;
  SE3 body, before, after;
  if (!BodyAt(view, values, 0, &body) || !BodyAt(view, values, -kAround, &before) ||
      !BodyAt(view, values, kAround, &after)) {
    return term;
  }
  const SE3& T_body_camera = values.T_body_camera;
  const AlignmentTerm of_pose =
      EvaluateAlignment(settings_, fields_[view], 0, points_[view], body * T_body_camera, true);
  const double seconds = 2 * ToSeconds(kAround);
  const Eigen::Vector3d velocity = (after.p - before.p) / seconds,
                        rate = LogSO3(before.q.conjugate() * after.q) / seconds;
  Eigen::Matrix<double, 6, 8> J = Eigen::Matrix<double, 6, 8>::Zero();  // of T_map_camera's tangent
  J.topLeftCorner<3, 3>() = body.R();
  J.block<3, 3>(3, 3).setIdentity();
  J.block<3, 1>(0, 6) = velocity + body.R() * rate.cross(T_body_camera.p);
  J.block<3, 1>(3, 6) = T_body_camera.R().transpose() * rate;
  J.col(7) = -J.col(6) / ((*views_)[view].speed_px + kSlow);
  term.cost = of_pose.cost;
  term.gradient = J.transpose() * of_pose.gradient;
  term.hessian = J.transpose() * of_pose.hessian * J;
  return term;
}

std::vector<OverlapCost::Term> OverlapCost::Each(const Values& values) const {
  std::vector<Term> terms;
  terms.reserve(fields_.size());
  for (std::size_t k = 0; k < fields_.size(); ++k) terms.push_back(Of(k, values));
  return terms;
}

OverlapCost::Term OverlapCost::Total(const Values& values) const {
  Term sum;
  for (const Term& term : Each(values)) {
    sum.cost += term.cost;
    sum.gradient += term.gradient;
    sum.hessian += term.hessian;
  }
  return sum;
}

double OverlapCost::Sparse(const Values& values, std::size_t every) const {
  double sum = 0;
  for (std::size_t k = 0; k < fields_.size(); k += every) {
    SE3 body;
    if (BodyAt(k, values, 0, &body))
      sum += EvaluateAlignment(settings_, fields_[k], 0, points_[k], body * values.T_body_camera, false).cost;
  }
  return sum;
}

MapEventOverlap OverlapCost::Overlap(const Values& values) const {
  MapEventOverlap sum;
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    SE3 body;
    if (BodyAt(k, values, 0, &body))
      sum.Add(MeasureOverlap(settings_.camera(), body * values.T_body_camera, (*views_)[k]));
  }
  return sum;
}

}  // namespace evit
