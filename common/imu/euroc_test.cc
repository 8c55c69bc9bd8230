// Pre-integration on a real IMU: the EuRoC log in the shared data, where it is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/imu/preintegration.h"
#include "common/imu/propagation.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

constexpr double kGravity = 9.81;

struct Truth {
  Utime t = 0;
  NavState state;
  ImuBias bias;
};

// Rows of numbers; the stamps of the file are whole nanoseconds.
std::vector<std::vector<double>> ReadRows(const std::string& path, std::vector<Utime>* stamps) {
  std::vector<std::vector<double>> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::int64_t nanoseconds = 0;
    words >> nanoseconds;
    stamps->push_back(nanoseconds / 1000);
    rows.emplace_back();
    for (double v = 0; words >> v;) rows.back().push_back(v);
  }
  return rows;
}

class EurocTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string folder = test::RecordingsPath("euroc");
    if (!std::ifstream(folder + "/imu.csv")) GTEST_SKIP() << "no imu.csv in " << folder;
    std::vector<Utime> stamps;
    const auto readings = ReadRows(folder + "/imu.csv", &stamps);
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const auto& r = readings[k];
      imu_.push_back({stamps[k], {r[0], r[1], r[2]}, {r[3], r[4], r[5]}});
    }
    stamps.clear();
    const auto poses = ReadRows(folder + "/gt.csv", &stamps);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const auto& r = poses[k];
      truth_.push_back({stamps[k],
                        {{Eigen::Quaterniond(r[3], r[4], r[5], r[6]).normalized(), {r[0], r[1], r[2]}},
                         {r[7], r[8], r[9]}},
                        {{r[10], r[11], r[12]}, {r[13], r[14], r[15]}}});
    }
  }

  // The samples between two instants, with interpolated boundaries; empty where the log has them not all.
  std::vector<ImuSample> Between(Utime begin, Utime end) const {
    std::vector<ImuSample> samples;
    for (std::size_t k = 1; k < imu_.size(); ++k) {
      const ImuSample &a = imu_[k - 1], &b = imu_[k];
      if (a.t <= begin && begin < b.t) samples.push_back(InterpolateImu(a, b, begin));
      if (begin < b.t && b.t < end) samples.push_back(b);
      if (a.t < end && end <= b.t && !samples.empty()) {
        samples.push_back(InterpolateImu(a, b, end));
        return samples;
      }
    }
    return {};
  }

  std::vector<ImuSample> imu_;
  std::vector<Truth> truth_;
};

TEST_F(EurocTest, PredictsTheRealMotionOverAKeyframeInterval) {
  const ImuNoise noise{1.7e-4, 2.0e-3, 2e-5, 3e-3};  // EuRoC's own sensor.yaml
  std::vector<double> position, velocity, turn;
  for (std::size_t k = 0; k + 2 < truth_.size(); k += 8) {
    const Truth &a = truth_[k], &b = truth_[k + 2];  // 50 ms
    const std::vector<ImuSample> samples = Between(a.t, b.t);
    if (samples.size() < 3) continue;
    const Preintegration pre(samples, a.bias, noise);
    const double dt = pre.dt();
    const Eigen::Vector3d g(0, 0, -kGravity);
    const Eigen::Quaterniond& q = a.state.T_map_body.q;
    position.push_back((a.state.T_map_body.p + dt * a.state.velocity + 0.5 * dt * dt * g +
                        q * pre.delta().alpha - b.state.T_map_body.p)
                           .norm());
    velocity.push_back((a.state.velocity + dt * g + q * pre.delta().beta - b.state.velocity).norm());
    turn.push_back(AngularDistance(q * pre.delta().gamma, b.state.T_map_body.q));
  }
  ASSERT_GT(position.size(), 150u);
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
    return v[v.size() / 2];
  };
  RecordProperty("position_mm", std::to_string(1e3 * median(position)));
  RecordProperty("velocity_mm_s", std::to_string(1e3 * median(velocity)));
  RecordProperty("turn_mrad", std::to_string(1e3 * median(turn)));
  // Measured: 0.14 mm, 3.5 mm/s, 0.15 mrad, the size of the smoothed ground truth itself.
  EXPECT_LT(median(position), 0.0005);
  EXPECT_LT(median(velocity), 0.01);
  EXPECT_LT(median(turn), 0.0005);
}

TEST_F(EurocTest, BiasCorrectionMattersAndIsTheRepropagation) {
  const ImuNoise noise{1.7e-4, 2.0e-3, 2e-5, 3e-3};
  int compared = 0;
  for (std::size_t k = 100; k + 4 < truth_.size(); k += 50) {
    const Truth &a = truth_[k], &b = truth_[k + 4];
    const std::vector<ImuSample> samples = Between(a.t, b.t);
    if (samples.empty()) continue;  // the ground truth continues after the IMU log's end
    ++compared;
    Preintegration pre(samples, {}, noise);
    const Preintegration::Delta raw = pre.delta(), corrected = pre.Corrected(a.bias);
    pre.Repropagate(a.bias);
    const double left = AngularDistance(corrected.gamma, pre.delta().gamma);
    EXPECT_LT(left, 0.02 * AngularDistance(raw.gamma, pre.delta().gamma));
    EXPECT_LT((corrected.beta - pre.delta().beta).norm(), 0.02 * (raw.beta - pre.delta().beta).norm());
  }
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace evit
