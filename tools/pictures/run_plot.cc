#include "tools/pictures/run_plot.h"

#include "common/geometry/degrees.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/write_picture.h"

namespace evit::pictures {
namespace {

constexpr int kDashes[3] = {0, 14, 5};  // of x, y and z: told apart without colour too
const cv::Scalar kTruth(170, 170, 170), kError(150, 50, 130);

// Rotation relative to `reference` as a rotation vector, degrees: unlike Euler angles it does not jump.
Eigen::Vector3d Turn(const Eigen::Quaterniond& reference, const Eigen::Quaterniond& q) {
  return kDegreesPerRadian * LogSO3(reference.conjugate() * q);
}

}  // namespace

void PlotRun(const std::string& path, const std::string& title, const Trajectory& truth,
             const Trajectory& estimate) {
  cv::Mat image(1130, 1500, CV_8UC3, cv::Scalar(255, 255, 255));
  DrawText(&image, title, {750, 40}, 0.8, Anchor::kCenter, {20, 20, 20}, 2);

  const Trajectory& base = estimate.empty() ? truth : estimate;
  const Utime t0 = base.empty() ? 0 : base.front().t;
  const Eigen::Quaterniond reference = base.empty() ? Eigen::Quaterniond::Identity() : base.front().pose.q;
  Chart position{"position", "time [s]", "[m]", {}, false, false};
  Chart rotation{"rotation since the start", "time [s]", "[deg]", {}, false, false};
  Chart top{"from above", "x [m]", "y [m]", {}, true, false};
  Chart position_error{"position error (map frame, no alignment)", "time [s]", "[cm]", {}, false, true};
  Chart rotation_error{"orientation error", "time [s]", "[deg]", {}, false, true};
  const char* axes[3] = {"x", "y", "z"};

  Series path_truth{"truth", kTruth, {}, {}, true, 0},
      path_estimate{"estimate", kSafeColors[2], {}, {}, true, 0};
  for (int axis = 0; axis < 3; ++axis) {
    Series p_truth{axis == 0 ? "truth" : "", kTruth, {}, {}, true, 0.3}, r_truth = p_truth;
    Series p{axes[axis], kSafeColors[axis], {}, {}, true, 0.3, kDashes[axis]}, r = p;
    for (const StampedPose& s : truth) {
      if (!estimate.empty() && (s.t < estimate.front().t || s.t > estimate.back().t)) continue;
      p_truth.x.push_back(ToSeconds(s.t - t0));
      r_truth.x.push_back(ToSeconds(s.t - t0));
      p_truth.y.push_back(s.pose.p[axis]);
      r_truth.y.push_back(Turn(reference, s.pose.q)[axis]);
      if (axis == 0) path_truth.x.push_back(s.pose.p.x()), path_truth.y.push_back(s.pose.p.y());
    }
    for (const StampedPose& s : estimate) {
      p.x.push_back(ToSeconds(s.t - t0));
      r.x.push_back(ToSeconds(s.t - t0));
      p.y.push_back(s.pose.p[axis]);
      r.y.push_back(Turn(reference, s.pose.q)[axis]);
      if (axis == 0) path_estimate.x.push_back(s.pose.p.x()), path_estimate.y.push_back(s.pose.p.y());
    }
    for (auto& [chart, a, b] : {std::tie(position, p_truth, p), std::tie(rotation, r_truth, r)}) {
      chart.series.push_back(a);
      chart.series.push_back(b);
    }
  }
  top.series = {path_truth, path_estimate};
  Series dp{"", kError, {}, {}, true, 0.3}, dr = dp;
  for (const StampedPose& s : estimate) {
    SE3 at;
    if (!PoseAt(truth, s.t, &at)) continue;
    dp.x.push_back(ToSeconds(s.t - t0));
    dr.x.push_back(ToSeconds(s.t - t0));
    dp.y.push_back(100 * (s.pose.p - at.p).norm());
    dr.y.push_back(kDegreesPerRadian * AngularDistance(s.pose.q, at.q));
  }
  if (dp.x.empty()) position_error.title = rotation_error.title = "error: no ground truth";
  position_error.series = {dp};
  rotation_error.series = {dr};

  position.Draw(&image, {10, 60, 960, 350});
  rotation.Draw(&image, {10, 410, 960, 350});
  top.Draw(&image, {980, 60, 510, 700});
  position_error.Draw(&image, {10, 765, 740, 350});
  rotation_error.Draw(&image, {755, 765, 735, 350});
  WritePicture(path, image);
}

}  // namespace evit::pictures
