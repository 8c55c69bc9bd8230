#include "common/alignment/clock_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace evit {
namespace {

constexpr Utime kStep = 2'000;             // us between the offsets that are tried
constexpr std::size_t kFewestPairs = 100;  // pairs of flow and gyro: 2 s
constexpr double kLeastExplained = 0.5;
constexpr Utime kNear = 100'000;     // us: a rival further away than this must fit clearly worse
constexpr double kRivalShare = 0.9;  // of what the best explains

// Mean angular rates over any interval: differences of their integral.
class GyroIntegral {
 public:
  explicit GyroIntegral(const std::vector<ImuSample>& imu)
      : imu_(imu), sum_(imu.size(), Eigen::Vector3d::Zero()) {
    for (std::size_t k = 1; k < imu.size(); ++k)
      sum_[k] = sum_[k - 1] + 0.5 * ToSeconds(imu[k].t - imu[k - 1].t) * (imu[k].gyro + imu[k - 1].gyro);
  }
  bool Mean(Utime begin, Utime end, Eigen::Vector3d* mean) const {
    if (begin < imu_.front().t || end > imu_.back().t) return false;
    *mean = (At(end) - At(begin)) / ToSeconds(end - begin);
    return true;
  }

 private:
  Eigen::Vector3d At(Utime t) const {
    const auto after =
        std::upper_bound(imu_.begin(), imu_.end(), t, [](Utime a, const ImuSample& s) { return a < s.t; });
    if (after == imu_.end()) return sum_.back();
    const auto k = static_cast<std::size_t>(after - imu_.begin());
    const double share =
        static_cast<double>(t - imu_[k - 1].t) / static_cast<double>(imu_[k].t - imu_[k - 1].t);
    return sum_[k - 1] + share * (sum_[k] - sum_[k - 1]);
  }
  const std::vector<ImuSample>& imu_;
  std::vector<Eigen::Vector3d> sum_;
};

// A stretch of the flow that is left out.
struct Skipped {
  std::size_t begin = 0, end = 0;
};

// The share of the flow's variance that a linear function of the gyro explains, IMU stamps shifted by
// `offset`; -1: fewer than `fewest` pairs.
double Explained(const std::vector<FlowSample>& flow, const GyroIntegral& gyro, Utime offset,
                 std::size_t fewest = kFewestPairs, Skipped skipped = {}) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 2> right = Eigen::Matrix<double, 4, 2>::Zero();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0, n = 0;
  for (std::size_t k = 0; k < flow.size(); ++k) {
    const FlowSample& s = flow[k];
    Eigen::Vector3d rate;
    if (k >= skipped.begin && k < skipped.end) continue;
    if (!gyro.Mean(s.t - EventFlow::kWindow - offset, s.t + EventFlow::kWindow - offset, &rate)) continue;
    const Eigen::Vector4d x(rate.x(), rate.y(), rate.z(), 1);
    const Eigen::Vector2d v(s.vx, s.vy);
    normal += x * x.transpose();
    right += x * v.transpose();
    sum += v;
    squares += v.squaredNorm();
    ++n;
  }
  if (n < static_cast<double>(fewest)) return -1;
  const double variance = squares - sum.squaredNorm() / n;
  if (variance <= 0) return 0;
  normal.diagonal().head<3>().array() += 1e-9 * n;
  const Eigen::Matrix<double, 4, 2> solution = normal.ldlt().solve(right);
  const double residual = squares - (solution.array() * right.array()).sum();
  return std::clamp(1 - residual / variance, 0.0, 1.0);
}

// Where a parabola through the largest value and its neighbours has its top: steps from the beginning.
double TopOf(const std::vector<double>& values) {
  const auto best = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  if (best == 0 || best + 1 == values.size()) return static_cast<double>(best);
  const double left = values[best - 1], right = values[best + 1], curve = left - 2 * values[best] + right;
  const double fraction = left >= 0 && right >= 0 && curve < 0 ? 0.5 * (left - right) / curve : 0;
  return static_cast<double>(best) + fraction;
}

}  // namespace

ClockAlignment AlignClocks(const std::vector<FlowSample>& flow, const std::vector<ImuSample>& imu,
                           Utime guess, Utime range) {
  if (flow.size() < kFewestPairs || imu.size() < 2) {
    throw std::runtime_error(
        "the clocks cannot be aligned: only " + std::to_string(flow.size()) +
        " windows of 20 ms show how the image moves; at least 100 are needed: give --imu-offset");
  }
  const bool overlap = imu.front().t + guess < flow.back().t && imu.back().t + guess > flow.front().t;
  if (!overlap) guess = flow.front().t - imu.front().t;
  const GyroIntegral gyro(imu);
  std::vector<double> explained;
  for (Utime offset = guess - range; offset <= guess + range; offset += kStep)
    explained.push_back(Explained(flow, gyro, offset));
  const auto best =
      static_cast<std::size_t>(std::max_element(explained.begin(), explained.end()) - explained.begin());
  const auto why = [](const std::string& reason) {
    throw std::runtime_error("the clocks cannot be aligned: " + reason +
                             "; give --imu-offset, or a part with quick rotation to and fro");
  };
  if (explained[best] < 0) why("events and IMU do not overlap for 2 s");
  if (explained[best] < kLeastExplained)
    why("at no offset does the gyro explain more than " + std::to_string(std::lround(100 * explained[best])) +
        " % of the image's motion");
  double rival = 0;
  for (std::size_t k = 0; k < explained.size(); ++k) {
    const Utime away = std::abs(static_cast<Utime>(k) - static_cast<Utime>(best)) * kStep;
    if (away > kNear) rival = std::max(rival, explained[k]);
  }
  if (rival > kRivalShare * explained[best]) why("the motion is too steady, another offset fits as well");
  if (best == 0 || best + 1 == explained.size())
    why("the best offset is at the end of the range that was searched");
  return {guess - range + std::llround(TopOf(explained) * static_cast<double>(kStep)), explained[best]};
}

RotationLag FindRotationLag(const std::vector<FlowSample>& flow, const std::vector<ImuSample>& imu,
                            Utime range) {
  constexpr std::size_t kParts = 8, kFewest = 60;  // 1.2 s of flow
  RotationLag lag;
  if (flow.size() < kFewest || imu.size() < 2) return lag;
  const GyroIntegral gyro(imu);
  lag.explained_as_is = Explained(flow, gyro, 0, kFewest);
  if (lag.explained_as_is < 0) return lag;
  lag.pairs = flow.size();
  const Utime last = 2 * range / kStep;  // steps
  const auto find = [&](Skipped skipped, double* explained) {
    std::vector<double> shares;
    for (Utime k = 0; k <= last; ++k)
      shares.push_back(Explained(flow, gyro, k * kStep - range, kFewest / 2, skipped));
    *explained = *std::max_element(shares.begin(), shares.end());
    return TopOf(shares) * static_cast<double>(kStep) - static_cast<double>(range);
  };
  const double best = find({}, &lag.explained);
  // At an end: the best may lie beyond, and all eighths would agree on the end.
  if (best <= static_cast<double>(-range) || best >= static_cast<double>(last * kStep - range)) {
    lag.pairs = 0;
    return lag;
  }
  lag.offset = std::llround(best);
  std::vector<double> offsets;
  double mean = 0, variance = 0, unused = 0;
  for (std::size_t k = 0; k < kParts; ++k) {
    offsets.push_back(find({flow.size() * k / kParts, flow.size() * (k + 1) / kParts}, &unused));
    mean += offsets.back() / kParts;
  }
  for (const double offset : offsets) variance += (offset - mean) * (offset - mean) * (kParts - 1) / kParts;
  lag.sigma = std::sqrt(variance);
  return lag;
}

}  // namespace evit
