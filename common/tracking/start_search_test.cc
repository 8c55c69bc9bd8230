#include "common/tracking/start_search.h"

#include <gtest/gtest.h>

#include <random>

#include "common/tracking/alignment_significance.h"
#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

class StartSearchTest : public ::testing::Test {
 protected:
  AlignmentSettings settings_ = synthetic::Alignment();
  std::vector<Eigen::Vector3f> room_ = synthetic::RoomPoints();
  SE3 truth_{ExpSO3({0.02, 0.05, -0.04}), {0.05, -0.02, 0.03}};
  SurfaceField field_{synthetic::DrawSurface(settings_, room_, truth_), 4};
  AlignmentPoints points_{room_};
  StartRange range_;
};

// Whatever the depth: from a wrong start the coarse levels find the way, and from the right one they do not
// lose it.
TEST_F(StartSearchTest, LocalizeBestNeverEndsLessSureThanAnyDepth) {
  SE3 start = truth_;
  start.p += Eigen::Vector3d(0.02, 0.03, -0.02);
  const LocalizerResult best = LocalizeBest(settings_, field_, points_, start, range_);
  const double sure = AlignmentSignificance(settings_, field_, points_, best.T_map_body);
  EXPECT_GE(sure, AlignmentSignificance(settings_, field_, points_, start));
  for (int depth = 1; depth <= 4; ++depth) {
    StartRange shallow = range_;
    shallow.levels = depth;
    const LocalizerResult fit = Localize(settings_, field_, points_, start, shallow);
    EXPECT_GE(sure, AlignmentSignificance(settings_, field_, points_, fit.T_map_body)) << depth;
  }
  EXPECT_LT((best.T_map_body.p - truth_.p).norm(), 0.005);
}

TEST_F(StartSearchTest, FindsThePoseFromSomeCentimetresAndDegrees) {
  int right = 0;
  for (int k = 0; k < 10; ++k) {
    SE3 start = truth_;
    start.p += 0.05 * Eigen::Vector3d(std::sin(k), std::cos(2.0 * k), std::sin(3.0 * k)).normalized();
    start.q = start.q *
              ExpSO3(0.052 * Eigen::Vector3d(std::cos(k), std::sin(5.0 * k), std::cos(4.0 * k)).normalized());
    const SE3 found = SearchStart(settings_, field_, points_, start, range_, k).T_map_body;
    right += (found.p - truth_.p).norm() < 0.01 && AngularDistance(found.q, truth_.q) < 0.01 ? 1 : 0;
  }
  EXPECT_EQ(right, 10);
}

TEST_F(StartSearchTest, ARivalOfTheRightPoseIsWorseAndOneOfAWrongPoseBetter) {
  const StartRival of_truth = FindRival(settings_, field_, points_, truth_, range_, 1);
  EXPECT_TRUE(!of_truth.distinct || of_truth.significance > 0);
  SE3 wrong = truth_;
  wrong.p += Eigen::Vector3d(0, 0.06, 0.03);
  const StartRival of_wrong = FindRival(settings_, field_, points_, wrong, range_, 1);
  EXPECT_TRUE(of_wrong.distinct);
  EXPECT_LT(of_wrong.significance, -kPreferredSignificance);
  EXPECT_LT((of_wrong.T_map_body.p - truth_.p).norm(), 0.01);
}

// A narrow view of a wall with little before it: moving sideways and turning back hardly shows, so a false
// pose may lie far beyond the range of a start.
TEST(StartSearchOnAWall, FindsTheRightPoseAlongTheWayThatTheEventsSayLeastAbout) {
  AlignmentSettings settings = synthetic::Alignment();
  Camera camera = settings.camera();
  camera.width = 190, camera.height = 180, camera.fx = camera.fy = 198, camera.cx = 95, camera.cy = 90;
  settings.set_camera(camera);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Eigen::Vector3f> wall;
  for (int line = 0; line < 60; ++line) {
    const double depth = line % 6 == 0 ? 1.0 : 1.6;
    const Eigen::Vector3d a(depth, u(rng), u(rng)), along = 0.25 * Eigen::Vector3d(0, u(rng), u(rng));
    for (int i = 0; i < 40; ++i) wall.push_back((a + along * (i / 39.0)).cast<float>());
  }
  const AlignmentPoints points(wall);
  const SE3 truth;
  const SurfaceField field(synthetic::DrawSurface(settings, wall, truth, 0.8), 4);
  for (const double sideways : {-0.3, -0.15, 0.15, 0.3}) {
    const SE3 wrong(ExpSO3({0, 0, -std::atan(sideways / 1.6)}), {0, sideways, 0});
    const StartRival rival = FindRival(settings, field, points, wrong, StartRange(), 1);
    EXPECT_TRUE(rival.distinct) << sideways;
    EXPECT_LT(rival.significance, -kPreferredSignificance) << sideways;
    // In the right valley; frames that follow walk the rest of it.
    EXPECT_LT((rival.T_map_body.p - truth.p).norm(), 0.25 * std::abs(sideways)) << sideways;
  }
}

TEST_F(StartSearchTest, WithoutEventsTheStartStaysWhereItIs) {
  const SurfaceField empty(cv::Mat(480, 640, CV_8UC1, cv::Scalar(255)), 4);
  const SE3 found = SearchStart(settings_, empty, points_, truth_, range_, 3).T_map_body;
  EXPECT_LT((found.p - truth_.p).norm(), 1e-6);
}

}  // namespace
}  // namespace evit
