#include "common/calibration/rate_alignment.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace evit {
namespace {

constexpr Utime kShortestInterval = 40'000,
                kLongestInterval = 80'000;     // us: of an interval; shorter ones are all noise
constexpr Utime kCoarse = 2'000, kFine = 100;  // us: steps of the search
constexpr int kFewest = 20;

struct Interval {
  Utime a, b;
  Eigen::Vector3d rate;  // of the camera, camera frame, rad/s
};

std::vector<Interval> Intervals(const Trajectory& camera) {
  std::vector<Interval> intervals;
  std::size_t j = 0;
  for (std::size_t i = 0; i < camera.size(); ++i) {
    j = std::max(j, i);
    while (j < camera.size() && camera[j].t - camera[i].t < kShortestInterval) ++j;
    if (j == camera.size()) break;
    if (camera[j].t - camera[i].t > kLongestInterval) continue;  // a hole
    if (!intervals.empty() && camera[i].t - intervals.back().a < kShortestInterval / 4)
      continue;  // says it all over
    const double dt = ToSeconds(camera[j].t - camera[i].t);
    intervals.push_back(
        {camera[i].t, camera[j].t, LogSO3(camera[i].pose.q.conjugate() * camera[j].pose.q) / dt});
  }
  return intervals;
}

RateAlignment AlignAt(const std::vector<Interval>& intervals, const ImuTrack& imu, Utime offset) {
  RateAlignment out;
  out.offset = offset;
  std::vector<Eigen::Vector3d> gyro;
  Eigen::Vector3d mean_camera = Eigen::Vector3d::Zero(), mean_gyro = Eigen::Vector3d::Zero();
  for (const Interval& i : intervals) {
    const Utime a = i.a + offset, b = i.b + offset;
    gyro.push_back(LogSO3(imu.Turn(a).conjugate() * imu.Turn(b)) / ToSeconds(b - a));
    mean_camera += i.rate;
    mean_gyro += gyro.back();
  }
  out.n = static_cast<int>(intervals.size());
  mean_camera /= out.n;
  mean_gyro /= out.n;
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero(), scatter = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < gyro.size(); ++k) {
    const Eigen::Vector3d c = intervals[k].rate - mean_camera;
    across += (gyro[k] - mean_gyro) * c.transpose();
    scatter += c * c.transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(across, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign(2, 2) = -1;
  const Eigen::Matrix3d R = svd.matrixU() * sign * svd.matrixV().transpose();
  out.q_body_camera = Eigen::Quaterniond(R).normalized();
  out.gyro_bias = mean_gyro - R * mean_camera;
  double sum = 0;
  for (std::size_t k = 0; k < gyro.size(); ++k) {
    sum += (gyro[k] - R * intervals[k].rate - out.gyro_bias).squaredNorm();
  }
  out.rms = std::sqrt(sum / out.n);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter / out.n);
  out.spread = axes.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
  return out;
}

}  // namespace

RateAlignment AlignRates(const Trajectory& camera, const ImuTrack& imu, Utime max_offset) {
  std::vector<Interval> intervals = Intervals(camera);
  intervals.erase(std::remove_if(intervals.begin(), intervals.end(),
                                 [&](const Interval& i) {
                                   return !imu.Covers(i.a - max_offset) || !imu.Covers(i.b + max_offset);
                                 }),
                  intervals.end());
  if (intervals.size() < kFewest) return {};
  RateAlignment best;
  best.rms = std::numeric_limits<double>::infinity();
  const auto search = [&](Utime from, Utime to, Utime step) {
    for (Utime offset = from; offset <= to; offset += step) {
      const RateAlignment here = AlignAt(intervals, imu, offset);
      if (here.rms < best.rms) best = here;
    }
  };
  search(-max_offset, max_offset, kCoarse);
  const Utime middle = best.offset;
  const Utime from = std::max(middle - kCoarse, -max_offset), to = std::min(middle + kCoarse, max_offset);
  // The squared error is a parabola near its minimum.
  const double left = std::pow(AlignAt(intervals, imu, from).rms, 2), here = std::pow(best.rms, 2),
               right = std::pow(AlignAt(intervals, imu, to).rms, 2), bend = left - 2 * here + right;
  if (bend > 0) {
    const Utime vertex = middle + std::llround(0.5 * static_cast<double>(kCoarse) * (left - right) / bend);
    search(std::max(vertex - 2 * kFine, from), std::min(vertex + 2 * kFine, to), kFine);
  }
  return best;
}

}  // namespace evit
