#include "common/tracking/alignment_significance.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

std::vector<Eigen::Vector3f> EveryNth(const std::vector<Eigen::Vector3f>& points, std::size_t n,
                                      std::size_t first) {
  std::vector<Eigen::Vector3f> some;
  for (std::size_t k = first; k < points.size(); k += n) some.push_back(points[k]);
  return some;
}

// Of a map most of whose edges cause no events: the contrast is that of a wrong pose.
TEST(AlignmentSignificance, KnowsARightPoseWhereFewEdgesCauseEvents) {
  const AlignmentSettings settings = synthetic::Alignment();
  const SE3 pose;
  std::vector<Eigen::Vector3f> map = synthetic::RoomPoints(60, 1);
  const SurfaceField field(synthetic::DrawSurface(settings, map, pose), 1);
  const auto silent = synthetic::RoomPoints(500, 2);
  map.insert(map.end(), silent.begin(), silent.end());
  const AlignmentPoints points(EveryNth(map, 10, 0));
  EXPECT_LT(MeasureAlignment(settings, field, points, pose).contrast(), 0.2);
  EXPECT_GT(AlignmentSignificance(settings, field, points, pose), 4);
}

TEST(AlignmentSignificance, OfEventsThatHaveNothingToDoWithTheMapIsChance) {
  const AlignmentSettings settings = synthetic::Alignment();
  int over = 0;
  double squares = 0;
  constexpr int kTrials = 60;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    const SurfaceField field(synthetic::DrawSurface(settings, synthetic::RoomPoints(60, 100 + trial), SE3()),
                             1);
    const AlignmentPoints points(EveryNth(synthetic::RoomPoints(60, 1000 + trial), 3, 0));
    const double z = AlignmentSignificance(settings, field, points, SE3());
    over += z > 3 ? 1 : 0;
    squares += z * z;
  }
  EXPECT_LE(over, 1);
  EXPECT_NEAR(squares / kTrials, 1, 0.5);
}

TEST(AlignmentSignificance, AVerdictIsBothFigures) {
  const AlignmentSettings settings = synthetic::Alignment();
  const SurfaceField field(synthetic::DrawSurface(settings, synthetic::RoomPoints(), SE3()), 1);
  const AlignmentPoints points(synthetic::RoomPoints());
  const AlignmentVerdict verdict = JudgeAlignment(settings, field, points, SE3());
  const AlignmentQuality quality = MeasureAlignment(settings, field, points, SE3());
  EXPECT_EQ(verdict.significance, AlignmentSignificance(settings, field, points, SE3()));
  EXPECT_GT(verdict.significance, 0);
  EXPECT_EQ(verdict.quality.n_points, quality.n_points);
  EXPECT_EQ(verdict.quality.mean_value, quality.mean_value);
  EXPECT_EQ(verdict.quality.shifted_value, quality.shifted_value);
  EXPECT_EQ(verdict.quality.inlier_share, quality.inlier_share);
}

TEST(AlignmentSignificance, WithoutPointsInViewIsZero) {
  const AlignmentSettings settings = synthetic::Alignment();
  const SurfaceField field(synthetic::DrawSurface(settings, synthetic::RoomPoints(), SE3()), 1);
  EXPECT_EQ(AlignmentSignificance(settings, field, AlignmentPoints(), SE3()), 0);
}

}  // namespace
}  // namespace evit
