#include "tools/pictures/run_plot.h"

#include <algorithm>

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

bool IsBreak(const std::vector<Utime>& breaks, Utime t) {
  return std::binary_search(breaks.begin(), breaks.end(), t);
}

struct PoseCharts {
  Chart position{"position", "", "[m]", {}, false, false};
  Chart rotation{"rotation since the first pose", "", "[deg]", {}, false, false};
  Chart top{"from above", "x [m]", "y [m]", {}, true, false};
};

// The axes of position and rotation, each as two lines, and the path from above.
PoseCharts ChartPoses(const Trajectory& truth, const Trajectory& estimate, const TimeAxis& time,
                      const std::vector<Utime>& breaks) {
  // Of the truth, if there is one: then runs that find their first pose at different times are alike.
  const Trajectory& base = truth.empty() ? estimate : truth;
  const Eigen::Quaterniond reference = base.empty() ? Eigen::Quaterniond::Identity() : base.front().pose.q;
  const auto add = [&](const StampedPose& s, int axis, Series* position, Series* rotation, Series* path) {
    position->x.push_back(time.At(s.t));
    rotation->x.push_back(time.At(s.t));
    position->y.push_back(s.pose.p[axis]);
    rotation->y.push_back(Turn(reference, s.pose.q)[axis]);
    if (axis == 0) path->x.push_back(s.pose.p.x()), path->y.push_back(s.pose.p.y());
  };
  PoseCharts charts;
  charts.position.SetTime(time);
  charts.rotation.SetTime(time);
  if (!truth.empty()) charts.rotation.title += " of the truth";
  const char* axes[3] = {"x", "y", "z"};
  Series path_truth{"truth", kTruth, {}, {}, true, 0},
      path_estimate{"estimate", kSafeColors[2], {}, {}, true, 0};
  for (int axis = 0; axis < 3; ++axis) {
    Series p_truth{axis == 0 ? "truth" : "", kTruth, {}, {}, true, kLongestGap}, r_truth = p_truth;
    Series p{axes[axis], kSafeColors[axis], {}, {}, true, kLongestGap, kDashes[axis]}, r = p;
    for (const StampedPose& s : truth) add(s, axis, &p_truth, &r_truth, &path_truth);
    for (const StampedPose& s : estimate) {
      if (IsBreak(breaks, s.t)) p.Break(), r.Break();
      if (IsBreak(breaks, s.t) && axis == 0) path_estimate.Break();
      add(s, axis, &p, &r, &path_estimate);
    }
    charts.position.series.insert(charts.position.series.end(), {p_truth, p});
    charts.rotation.series.insert(charts.rotation.series.end(), {r_truth, r});
  }
  charts.top.series = {path_truth, path_estimate};
  return charts;
}

struct ErrorCharts {
  Chart position{"position error (map frame, no alignment)", "", "[cm]", {}, false, true};
  Chart rotation{"orientation error", "", "[deg]", {}, false, true};
};

ErrorCharts ChartErrors(const Trajectory& truth, const Trajectory& estimate, const TimeAxis& time,
                        const std::vector<Utime>& breaks) {
  ErrorCharts charts;
  charts.position.SetTime(time);
  charts.rotation.SetTime(time);
  Series position{"", kError, {}, {}, true, kLongestGap}, rotation = position;
  for (const StampedPose& s : estimate) {
    if (IsBreak(breaks, s.t)) position.Break(), rotation.Break();
    SE3 at;
    if (!PoseAt(truth, s.t, &at)) continue;
    position.x.push_back(time.At(s.t));
    rotation.x.push_back(time.At(s.t));
    position.y.push_back(100 * (s.pose.p - at.p).norm());
    rotation.y.push_back(kDegreesPerRadian * AngularDistance(s.pose.q, at.q));
  }
  if (position.x.empty()) charts.position.title = charts.rotation.title = "error: no ground truth";
  charts.position.series = {position};
  charts.rotation.series = {rotation};
  return charts;
}

}  // namespace

void PlotRun(const std::string& path, const std::string& title, const Trajectory& truth,
             const Trajectory& estimate, const TimeAxis& time, const std::vector<Utime>& breaks) {
  cv::Mat image(1130, 1500, CV_8UC3, cv::Scalar(255, 255, 255));
  DrawText(&image, title, {750, 40}, 0.8, Anchor::kCenter, {20, 20, 20}, 2);
  const PoseCharts poses = ChartPoses(truth, estimate, time, breaks);
  poses.position.Draw(&image, {10, 60, 960, 350});
  poses.rotation.Draw(&image, {10, 410, 960, 350});
  poses.top.Draw(&image, {980, 60, 510, 700});
  const ErrorCharts errors = ChartErrors(truth, estimate, time, breaks);
  errors.position.Draw(&image, {10, 765, 740, 350});
  errors.rotation.Draw(&image, {755, 765, 735, 350});
  WritePicture(path, image);
}

}  // namespace evit::pictures
