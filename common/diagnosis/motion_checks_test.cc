// What known poses say of accelerometer and motion.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/diagnosis/accel_axes.h"
#include "common/diagnosis/motion_check.h"
#include "common/geometry/so3.h"

namespace evit::diagnosis {
namespace {

struct Waving {
  std::vector<ImuSample> imu;
  Trajectory truth;
};

// A hand that waves: 4 s; `slower`: as many times.
Waving Wave(double slower, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& accel) {
  Waving m;
  const auto pose = [slower](double t) {
    t /= slower;
    return SE3(ExpSO3({0.1 * std::sin(2 * t), 0.2 * std::sin(3 * t), 0.3 * std::sin(t)}),
               {0.2 * std::sin(3 * t), 0.15 * std::sin(4 * t), 0.1 * std::sin(5 * t)});
  };
  for (int k = 0; k < 2000; ++k) {
    const double t = 0.002 * k, h = 0.001;
    const SE3 a = pose(t - h), b = pose(t), c = pose(t + h);
    const Eigen::Vector3d force = (a.p - 2 * b.p + c.p) / (h * h) + Eigen::Vector3d(0, 0, 9.81);
    m.imu.push_back(
        {std::llround(1e6 * t), LogSO3(a.q.conjugate() * c.q) / (2 * h), accel(b.q.conjugate() * force)});
    if (k % 4 == 0) m.truth.push_back({std::llround(1e6 * t), b});
  }
  return m;
}

TEST(AccelAxes, SwappedAndMirroredOnesAreNamed) {
  using V = Eigen::Vector3d;
  const auto check = [](const std::function<V(const V&)>& change) {
    const Waving m = Wave(1, change);
    return CheckAccelAxes(m.imu, m.truth, 9.81);
  };
  EXPECT_EQ(check([](const V& a) { return a; }).severity, Severity::kGood);
  EXPECT_EQ(check([](const V& a) { return V(a + V(0.2, -0.2, 0.1)); }).severity, Severity::kGood) << "a bias";
  const Finding swapped = check([](const V& a) { return V(a.y(), a.x(), a.z()); });
  EXPECT_EQ(swapped.severity, Severity::kError);
  EXPECT_NE(swapped.what.find("should be y, x, z"), std::string::npos) << swapped.what;
  const Finding mirrored = check([](const V& a) { return V(-a.x(), a.y(), a.z()); });
  EXPECT_NE(mirrored.what.find("should be -x, y, z"), std::string::npos) << mirrored.what;
}

// What turns the map turns gravity in it, not the accelerometer's axes.
TEST(AccelAxes, ATiltedMapIsNoOtherAxes) {
  Waving m = Wave(1, [](const Eigen::Vector3d& a) { return a; });
  const SE3 turn(ExpSO3({M_PI / 2, 0, 0}), Eigen::Vector3d::Zero());
  for (StampedPose& s : m.truth) s.pose = turn * s.pose;
  EXPECT_EQ(CheckAccelAxes(m.imu, m.truth, 9.81).severity, Severity::kGood);
}

TEST(MotionCheck, WhatHardlyMovesIsNamed) {
  const auto severity = [](double slower, bool poses) {
    const Waving m = Wave(slower, [](const Eigen::Vector3d& a) { return a; });
    return CheckMotion(m.imu, poses ? m.truth : Trajectory{}).severity;
  };
  for (const bool poses : {true, false}) {
    EXPECT_EQ(severity(1, poses), Severity::kGood);
    EXPECT_EQ(severity(3, poses), Severity::kGood);
    EXPECT_EQ(severity(60, poses), Severity::kError);
  }
}

}  // namespace
}  // namespace evit::diagnosis
