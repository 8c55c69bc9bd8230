#include "common/alignment/clock_alignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace evit {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kWidth = 346, kHeight = 260;
constexpr double kFocal = 250;

// A camera that turns among 3,000 points far away: each gives an event when it has moved by a pixel.
class Turning {
 public:
  explicit Turning(bool steady) {
    std::mt19937 rng(5);
    std::normal_distribution<double> normal;
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 3000; ++k)
      points.push_back(Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized());
    std::vector<Eigen::Vector2i> pixels(points.size(), {-1, -1});
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  // camera to world
    constexpr Utime kStep = 500;
    for (Utime t = 0; t < 8'000'000; t += kStep) {
      const double s = ToSeconds(t);
      const Eigen::Vector3d rate =
          steady ? Eigen::Vector3d(0.1, 0.8, 0)
                 : Eigen::Vector3d(1.2 * std::sin(2.1 * s) + 0.5 * std::sin(7.7 * s),
                                   std::sin(1.3 * s + 1) + 0.7 * std::sin(5.3 * s), 0.3 * std::sin(3 * s));
      for (std::size_t k = 0; k < points.size(); ++k) {
        const Eigen::Vector3d p = q.inverse() * points[k];
        const Eigen::Vector2i pixel =
            p.z() > 0.1 ? Eigen::Vector2i(std::lround(kFocal * p.x() / p.z() + kWidth / 2.0),
                                          std::lround(kFocal * p.y() / p.z() + kHeight / 2.0))
                        : Eigen::Vector2i(-1, -1);
        const bool inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < kWidth && pixel.y() < kHeight;
        if (inside && pixel != pixels[k])
          events_.push_back(t, static_cast<std::uint16_t>(pixel.x()), static_cast<std::uint16_t>(pixel.y()),
                            1);
        pixels[k] = inside ? pixel : Eigen::Vector2i(-1, -1);
      }
      if (t % 5000 == 0)
        imu_.push_back({t, R_imu_camera_ * rate + Eigen::Vector3d(0.02, -0.01, 0.03), {0, 0, 9.81}});
      const Eigen::Vector3d turn = rate * ToSeconds(kStep);
      q = (q * Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))).normalized();
    }
  }
  std::vector<FlowSample> Flow() const {
    EventFlow flow(kWidth, kHeight);
    flow.Add(events_);
    return flow.samples();
  }
  // With another clock: add `offset` to get that of the events.
  std::vector<ImuSample> Imu(Utime offset) const {
    std::vector<ImuSample> imu = imu_;
    for (ImuSample& s : imu) s.t -= offset;
    return imu;
  }

 private:
  const Eigen::Quaterniond R_imu_camera_ = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  EventArray events_;
  std::vector<ImuSample> imu_;
};

TEST(AlignClocks, TheOffsetIsFoundWithoutExtrinsics) {
  const Turning turning(false);
  const std::vector<FlowSample> flow = turning.Flow();
  for (const Utime offset : {Utime{0}, Utime{137'000}, Utime{-1'234'500}, Utime{1'700'000'000'000'000}}) {
    const ClockAlignment found = AlignClocks(flow, turning.Imu(offset), 0, 2'000'000);
    EXPECT_NEAR(static_cast<double>(found.offset - offset), 0, 3'000) << offset;
    EXPECT_GT(found.explained, 0.8);
  }
}

TEST(AlignClocks, ALagComesWithItsUncertainty) {
  const Turning turning(false);
  const std::vector<FlowSample> flow = turning.Flow();
  for (const Utime offset : {Utime{0}, Utime{50'000}, Utime{-30'000}}) {
    const RotationLag lag = FindRotationLag(flow, turning.Imu(offset), 200'000);
    EXPECT_NEAR(static_cast<double>(lag.offset - offset), 0, 3'000) << offset;
    EXPECT_LT(lag.sigma, 3'000);
    EXPECT_GT(lag.explained, 0.8);
    EXPECT_LE(lag.explained_as_is, lag.explained);
  }
  const Turning steady(true);
  const RotationLag lag = FindRotationLag(steady.Flow(), steady.Imu(0), 200'000);
  EXPECT_TRUE(lag.explained < 0.5 || lag.sigma > 20'000) << lag.explained << ", " << lag.sigma;
  EXPECT_EQ(FindRotationLag({}, steady.Imu(0), 200'000).pairs, 0U);
}

TEST(AlignClocks, ALagBeyondTheRangeIsNoResult) {
  const Turning turning(false);
  const std::vector<FlowSample> flow = turning.Flow();
  for (const Utime offset : {Utime{300'000}, Utime{-300'000}})
    EXPECT_EQ(FindRotationLag(flow, turning.Imu(offset), 200'000).pairs, 0U) << offset;
  for (const Utime offset : {Utime{190'000}, Utime{-190'000}})
    EXPECT_GT(FindRotationLag(flow, turning.Imu(offset), 200'000).pairs, 0U) << offset;
}

TEST(AlignClocks, SteadyOrNoMotionIsRefused) {
  const Turning turning(true);
  EXPECT_THAT([&] { AlignClocks(turning.Flow(), turning.Imu(0), 0, 2'000'000); },
              ThrowsMessage<std::runtime_error>(HasSubstr("cannot be aligned")));
  EXPECT_THAT([&] { AlignClocks({}, turning.Imu(0), 0, 2'000'000); },
              ThrowsMessage<std::runtime_error>(HasSubstr("only 0 windows")));
}

}  // namespace
}  // namespace evit
