// The real map of VECtor's sofa scene, seen from real poses, where the shared data is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "tests/helpers/clouds.h"
#include "tests/helpers/paths.h"

namespace evit {
namespace {

class SofaMapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = test::RecordingsPath("vector/sofa_fast");
    if (!std::ifstream(folder_ + "/map.txt")) GTEST_SKIP() << "no map.txt in " << folder_;
    loaded_ = LoadMap(folder_ + "/map.txt");
    poses_ = ReadTum(folder_ + "/poses_map_event.tum");
    query_.camera = test::PlumbBob();
    query_.max_depth = 10;
  }
  std::string folder_;
  LoadedMap loaded_;
  Trajectory poses_;
  VisibilityQuery query_;
};

TEST_F(SofaMapTest, IsARoomInMetres) {
  EXPECT_EQ(loaded_.map.points.size(), 65'026u);
  EXPECT_EQ(loaded_.n_dropped, 0u);
  EXPECT_EQ(loaded_.format, "text");
  const MapSummary summary = Summarize(loaded_.map);
  EXPECT_NO_THROW(RequireMetres(summary, "map.txt"));
  EXPECT_GT(summary.median_spacing, 0.0005);
  EXPECT_LT(summary.median_spacing, 0.05);
  for (auto& p : loaded_.map.points) p *= 1000;
  EXPECT_THROW(RequireMetres(Summarize(loaded_.map), "map.txt"), std::runtime_error);
}

TEST_F(SofaMapTest, RealPosesSeeIt) {
  const MapIndex index(loaded_.map);
  ASSERT_EQ(poses_.size(), 75u);
  double hidden = 0, all = 0;
  std::vector<double> ms;
  for (const StampedPose& pose : poses_) {
    query_.T_map_camera = pose.pose;
    query_.occlusion = false;
    const int without = index.Query(query_).n_visible;
    query_.occlusion = true;
    const auto begin = std::chrono::steady_clock::now();
    const int with = index.Query(query_).n_visible;
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    EXPECT_GT(with, 1000);
    EXPECT_LE(with, without);
    all += without;
    hidden += without - with;
  }
  std::sort(ms.begin(), ms.end());
  std::printf("%.0f points in view, %.1f %% of them hidden; %.2f ms a query, %.2f at most\n",
              all / static_cast<double>(poses_.size()), 100 * hidden / all, ms[ms.size() / 2], ms.back());
  // The rule is there to be careful: a map seen from where it was made must not fall apart.
  EXPECT_LT(hidden, 0.35 * all);
}

TEST_F(SofaMapTest, SeenFromBehindTheCameraNothingOfItShows) {
  const MapIndex index(loaded_.map);
  const MapSummary summary = Summarize(loaded_.map);
  // From 20 m away, looking on away from it: a point behind the camera projects to a pixel, too.
  const Eigen::Vector3d away = poses_[0].pose.q * Eigen::Vector3d::UnitZ();
  query_.T_map_camera = {poses_[0].pose.q, summary.median.cast<double>() + 20 * away};
  query_.max_depth = 100;
  EXPECT_EQ(index.Query(query_).n_visible, 0);
  query_.T_map_camera.p -= 40 * away;
  EXPECT_GT(index.Query(query_).n_visible, 50'000 / 10);
}

}  // namespace
}  // namespace evit
