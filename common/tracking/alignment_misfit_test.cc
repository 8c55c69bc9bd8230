#include "common/tracking/alignment_misfit.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

const AlignmentSettings kSettings = synthetic::Alignment();
const std::vector<Eigen::Vector3f> kRoom = synthetic::RoomPoints(120);

SurfaceField FieldOf(const std::vector<Eigen::Vector3f>& room) {
  return {synthetic::DrawSurface(kSettings, room, SE3()), 1};
}

// Lines of the room, each moved by so much (m, one sigma) as a whole.
std::vector<Eigen::Vector3f> WithLinesMoved(double sigma) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, static_cast<float>(sigma));
  std::vector<Eigen::Vector3f> moved = kRoom;
  for (std::size_t k = 0; k < moved.size(); k += 60) {
    const Eigen::Vector3f by(0, normal(random), normal(random));
    for (std::size_t i = k; i < k + 60; ++i) moved[i] += by;
  }
  return moved;
}

TEST(AlignmentMisfit, OfAMapThatIsRightIsBelowWhatThePixelGridLeaves) {
  const AlignmentMisfit misfit = MeasureMisfit(kSettings, FieldOf(kRoom), AlignmentPoints(kRoom), SE3());
  EXPECT_GT(misfit.n_patches, 30);
  EXPECT_LT(misfit.offset_px, 0.25);
  EXPECT_NEAR(misfit.metres_per_px, 2.75 / 327, 0.2 * 2.75 / 327);  // 1.5 to 4 m before the camera
}

TEST(AlignmentMisfit, GrowsWithWhatEdgesOfTheMapAreOff) {
  const SurfaceField field = FieldOf(kRoom);
  const AlignmentMisfit right = MeasureMisfit(kSettings, field, AlignmentPoints(kRoom), SE3());
  const AlignmentMisfit half = MeasureMisfit(kSettings, field, AlignmentPoints(WithLinesMoved(0.004)), SE3());
  EXPECT_GT(half.offset_px, right.offset_px + 0.1);  // half a pixel, one sigma
}

TEST(AlignmentMisfit, WithoutEventsOrPointsThereIsNone) {
  const cv::Mat nothing(480, 640, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(MeasureMisfit(kSettings, {nothing, 1}, AlignmentPoints(kRoom), SE3()).n_patches, 0);
  EXPECT_EQ(MeasureMisfit(kSettings, FieldOf(kRoom), AlignmentPoints(), SE3()).n_patches, 0);
}

}  // namespace
}  // namespace evit
