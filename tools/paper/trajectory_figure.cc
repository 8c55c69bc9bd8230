#include "tools/paper/trajectory_figure.h"

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "common/geometry/degrees.h"
#include "tools/pictures/chart.h"
#include "tools/pictures/write_picture.h"

namespace evit::paper {
namespace {

constexpr double kGap = 0.3;  // s
const cv::Scalar kTruth(150, 150, 150);
const cv::Scalar kColors[] = {{60, 140, 230}, {190, 110, 30}, {150, 50, 130}, {70, 150, 50},
                              {40, 40, 200},  {160, 160, 20}, {60, 90, 120}};

// Six curves over time: x, y, z in metres, then roll, pitch, yaw in degrees.
struct Curves {
  std::vector<double> t;
  std::vector<double> v[6];
};

// `T_truth_estimate` moves the poses; rotation is since `reference`, about the map's axes.
Curves CurvesOf(const Trajectory& poses, const SE3& T_truth_estimate, const Eigen::Quaterniond& reference,
                Utime begin) {
  Curves curves;
  double last[3] = {0, 0, 0};
  for (const StampedPose& s : poses) {
    const SE3 pose = T_truth_estimate * s.pose;
    const Eigen::Matrix3d R = (pose.q * reference.conjugate()).toRotationMatrix();
    double angles[3] = {std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                        std::atan2(R(1, 0), R(0, 0))};
    curves.t.push_back(ToSeconds(s.t - begin));
    for (int axis = 0; axis < 3; ++axis) {
      double& angle = angles[axis];
      while (angle - last[axis] > M_PI) angle -= 2 * M_PI;
      while (angle - last[axis] < -M_PI) angle += 2 * M_PI;
      last[axis] = angle;
      curves.v[axis].push_back(pose.p[axis]);
      curves.v[3 + axis].push_back(kDegreesPerRadian * angle);
    }
  }
  return curves;
}

struct Band {
  double low, high;
  bool Holds(double v) const { return v >= low && v <= high; }
};

// What is drawn: the truth's range and a half more on both sides.
Band BandOf(const std::vector<double>& truth) {
  if (truth.empty()) return {std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
  const auto [low, high] = std::minmax_element(truth.begin(), truth.end());
  const double margin = 0.5 * (*high - *low) + 1e-3;
  return {*low - margin, *high + margin};
}

void Legend(cv::Mat* image, const std::vector<MethodTrajectory>& methods, int y) {
  int x = 80;
  const auto entry = [&](const std::string& name, const cv::Scalar& color) {
    cv::line(*image, {x, y - 6}, {x + 34, y - 6}, color, 4, cv::LINE_AA);
    pictures::DrawText(image, name, {x + 42, y}, 0.6, pictures::Anchor::kLeft);
    int base = 0;
    x += 80 + cv::getTextSize(name, cv::FONT_HERSHEY_SIMPLEX, 0.6, 1, &base).width;
  };
  entry("truth", kTruth);
  for (std::size_t k = 0; k < methods.size(); ++k) entry(methods[k].name, kColors[k % std::size(kColors)]);
}

}  // namespace

void DrawTrajectories(const std::string& path, const std::string& title, const Trajectory& truth,
                      const std::vector<MethodTrajectory>& methods) {
  constexpr int kWidth = 1600, kTop = 90, kRow = 300;
  cv::Mat image(kTop + 3 * kRow + 10, kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  pictures::DrawText(&image, title, {kWidth / 2, 34}, 0.8, pictures::Anchor::kCenter, {20, 20, 20}, 2);
  Legend(&image, methods, 72);
  const Utime begin = truth.empty() ? 0 : truth.front().t;
  const Eigen::Quaterniond reference = truth.empty() ? Eigen::Quaterniond::Identity() : truth.front().pose.q;
  const Curves true_curves = CurvesOf(truth, {}, reference, begin);
  std::vector<Curves> curves;
  for (const MethodTrajectory& m : methods) {
    SE3 at, T_truth_estimate;
    for (const StampedPose& s : m.poses) {
      if (!PoseAt(truth, s.t, &at)) continue;
      T_truth_estimate = at * s.pose.Inverse();
      break;
    }
    curves.push_back(CurvesOf(m.poses, T_truth_estimate, reference, begin));
  }
  const char* names[6] = {"x [m]", "y [m]", "z [m]", "roll [deg]", "pitch [deg]", "yaw [deg]"};
  for (int c = 0; c < 6; ++c) {
    pictures::Chart chart{
        "", c % 3 == 2 ? "time since the start of the truth [s]" : "", names[c], {}, false, false};
    const Band band = BandOf(true_curves.v[c]);
    chart.series.push_back({"", kTruth, true_curves.t, true_curves.v[c], true, kGap});
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const cv::Scalar color = kColors[k % std::size(kColors)];
      pictures::Series line{"", color, {}, {}, true, kGap}, end{"", color, {}, {}, false, 0};
      for (std::size_t i = 0; i < curves[k].t.size(); ++i) {
        if (!band.Holds(curves[k].v[c][i])) continue;
        line.x.push_back(curves[k].t[i]);
        line.y.push_back(curves[k].v[c][i]);
      }
      constexpr double kEarly = 0.5;  // s before the truth's end: lost
      if (!line.x.empty() && !true_curves.t.empty() && curves[k].t.back() < true_curves.t.back() - kEarly) {
        end.x = {line.x.back()};
        end.y = {line.y.back()};
      }
      chart.series.push_back(line);
      chart.series.push_back(end);
    }
    chart.Draw(&image, {10 + (c / 3) * (kWidth / 2), kTop + (c % 3) * kRow, kWidth / 2 - 20, kRow});
  }
  pictures::WritePicture(path, image);
}

}  // namespace evit::paper
