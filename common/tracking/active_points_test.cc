#include "common/tracking/active_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

struct Cloud {
  std::vector<Eigen::Vector3f> points = synthetic::RoomPoints();
  std::vector<std::int32_t> ids;
  Cloud() : ids(points.size()) { std::iota(ids.begin(), ids.end(), 0); }
};

ActivePoints Make() { return {synthetic::VgaCamera(), synthetic::BodyCamera().Inverse(), 1}; }

TEST(ActivePoints, SampleDoesNotDependOnTheOrderOfArrival) {
  const Cloud cloud;
  ActivePoints a = Make(), b = Make();
  a.Merge(cloud.ids, cloud.points);
  std::vector<std::size_t> order(cloud.ids.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  for (std::size_t half = 0; half < 2; ++half) {
    std::vector<std::int32_t> ids;
    std::vector<Eigen::Vector3f> points;
    for (std::size_t k = half; k < order.size(); k += 2) {
      ids.push_back(cloud.ids[order[k]]);
      points.push_back(cloud.points[order[k]]);
    }
    b.Merge(ids, points);
  }
  EXPECT_EQ(a.size(), b.size());
  EXPECT_EQ(a.Sample(SE3(), 500, 9), b.Sample(SE3(), 500, 9));
  EXPECT_NE(a.Sample(SE3(), 500, 9), a.Sample(SE3(), 500, 10));
}

TEST(ActivePoints, MergeHoldsEachPointOnce) {
  const Cloud cloud;
  ActivePoints a = Make();
  a.Merge(cloud.ids, cloud.points);
  a.Merge(cloud.ids, cloud.points);
  EXPECT_EQ(a.size(), cloud.ids.size());
}

TEST(ActivePoints, ShiftIsHowFarPointsMoveOverTheImage) {
  const Cloud cloud;
  ActivePoints a = Make();
  EXPECT_EQ(a.Shift(SE3(), SE3()), std::numeric_limits<double>::infinity());  // none in view
  a.Merge(cloud.ids, cloud.points);
  EXPECT_EQ(a.Shift(SE3(), SE3()), 0);
  const double focal = synthetic::VgaCamera().fx;
  const SE3 turned(ExpSO3({0, 0, 0.02}), Eigen::Vector3d::Zero());
  EXPECT_GT(a.Shift(SE3(), turned), 0.02 * focal * 0.9);
  EXPECT_LT(a.Shift(SE3(), turned), 0.02 * focal * 2.1);  // farther at the image's border
  const SE3 nearer(Eigen::Quaterniond::Identity(), {0, 0.05, 0});
  EXPECT_GT(a.Shift(SE3(), nearer), 2);
  const SE3 away(ExpSO3({0, 0, EIGEN_PI}), Eigen::Vector3d::Zero());
  EXPECT_EQ(a.Shift(away, SE3()), std::numeric_limits<double>::infinity());  // behind the camera then
}

TEST(ActivePoints, RetainDropsWhatNoPoseSees) {
  const Cloud cloud;
  ActivePoints a = Make();
  a.Merge(cloud.ids, cloud.points);
  const SE3 away(ExpSO3({0, 0, EIGEN_PI}), Eigen::Vector3d::Zero());
  a.Retain({away, SE3()}, 0);
  EXPECT_GT(a.size(), 1000U);
  a.Retain({away}, 0);
  EXPECT_EQ(a.size(), 0U);
}

TEST(ActivePoints, SampleIsSpreadOverTheImage) {
  // 5,000 points in one spot and 300 all over: the spot must not eat the budget.
  ActivePoints a = Make();
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> u(-1, 1);
  std::vector<std::int32_t> ids;
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 5300; ++k) {
    ids.push_back(k);
    points.push_back(k < 5000 ? Eigen::Vector3f(3, 0.05f * u(rng), 0.05f * u(rng))
                              : Eigen::Vector3f(3, 2.0f * u(rng), 1.5f * u(rng)));
  }
  a.Merge(ids, points);
  const auto sample = a.Sample(SE3(), 400, 0);
  ASSERT_EQ(sample.size(), 400U);
  const auto spread =
      std::count_if(sample.begin(), sample.end(), [](const auto& p) { return p.tail(2).norm() > 0.1; });
  EXPECT_GT(spread, 200);
}

}  // namespace
}  // namespace evit
