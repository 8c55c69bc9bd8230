#include "common/localization/vertical_search.h"

#include <gtest/gtest.h>

#include "common/geometry/degrees.h"
#include "common/geometry/so3.h"

namespace evit {
namespace {

double Degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, a.dot(b))) * kDegreesPerRadian;
}

// Searches until one is within 8 degrees of the truth, which lies `off` degrees beside the estimate.
int Searches(double off, double sigma_degrees, double direction) {
  Upright upright{true, Eigen::Vector3d::UnitZ(), sigma_degrees / kDegreesPerRadian};
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0);
  const Eigen::Vector3d truth = ExpSO3(off / kDegreesPerRadian * axis) * upright.up;
  VerticalSearch search;
  for (int n = 1; n < 100; ++n)
    if (Degrees(search.Next(upright, Eigen::Quaterniond::Identity(), 0.05), truth) < 8) return n;
  return 100;
}

TEST(VerticalSearch, BeginsWithTheEstimate) {
  const Upright upright{true, Eigen::Vector3d(0.1, -0.3, 0.9).normalized(), 0.1};
  VerticalSearch search;
  EXPECT_LT(Degrees(search.Next(upright, Eigen::Quaterniond::Identity(), 0), upright.up), 1e-6);
}

TEST(VerticalSearch, TriesWhatIsLikelyFirstAndLeavesNothingOut) {
  for (double direction = 0; direction < 6; direction += 0.5) {
    EXPECT_EQ(Searches(2, 2, direction), 1);
    EXPECT_LE(Searches(12, 8, direction), 10);
    EXPECT_LE(Searches(20, 8, direction), 25);
    EXPECT_LE(Searches(15, 1.5, direction), 30);  // far more wrong than it says
  }
}

TEST(VerticalSearch, WhatWasTriedTurnsWithTheBody) {
  const Eigen::Quaterniond turn = ExpSO3({0.4, -0.2, 0.3});
  const Upright upright{true, Eigen::Vector3d::UnitZ(), 0.12};
  const Upright turned{true, turn * upright.up, upright.sigma};
  VerticalSearch still, turning;
  std::vector<Eigen::Vector3d> expected;
  for (int k = 0; k < 3; ++k) expected.push_back(still.Next(upright, Eigen::Quaterniond::Identity(), 0));
  EXPECT_LT(Degrees(turning.Next(upright, Eigen::Quaterniond::Identity(), 0), expected[0]), 1e-6);
  // The grid around the estimate may lie otherwise; how far from what was tried does not.
  const Eigen::Vector3d second = turning.Next(turned, turn, 0);
  EXPECT_NEAR(Degrees(second, turn * expected[0]), Degrees(expected[1], expected[0]), 2);
}

TEST(VerticalSearch, WhatWasTriedLongAgoIsTriedAgain) {
  const Upright upright{true, Eigen::Vector3d::UnitZ(), 0.05};
  VerticalSearch search;
  search.Next(upright, Eigen::Quaterniond::Identity(), 0);
  EXPECT_LT(Degrees(search.Next(upright, Eigen::Quaterniond::Identity(), 3), upright.up), 1e-6);
}

}  // namespace
}  // namespace evit
