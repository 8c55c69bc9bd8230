#include "common/tracking/keyframe_need.h"

#include <gtest/gtest.h>

namespace evit {
namespace {

// Keyframes 20 ms apart that leave a variance of 1 and 2 (position, rotation) besides a systematic one.
KeyframeNeed Need(double systematic_position, double systematic_rotation) {
  KeyframeNeed need;
  need.random = Matrix6d::Identity();
  need.random.bottomRightCorner<3, 3>() *= 2;
  need.systematic = Matrix6d::Zero();
  need.systematic.topLeftCorner<3, 3>().diagonal().array() += systematic_position;
  need.systematic.bottomRightCorner<3, 3>().diagonal().array() += systematic_rotation;
  need.interval = 20'000;
  need.image_speed = 10;
  return need;
}

TEST(UsefulInterval, TheRandomPartMayGrowToAThirdOfTheSystematic) {
  EXPECT_NEAR(static_cast<double>(UsefulInterval(Need(6, 100))), 40'000, 1);
  EXPECT_NEAR(static_cast<double>(UsefulInterval(Need(100, 12))), 40'000, 1);  // the worse of both counts
  EXPECT_NEAR(static_cast<double>(UsefulInterval(Need(1.5, 3))), 10'000, 1);
}

TEST(UsefulInterval, IsTheSameWhateverTheIntervalSoFar) {
  KeyframeNeed twice = Need(6, 100);
  twice.random *= 2;
  twice.interval *= 2;
  EXPECT_NEAR(static_cast<double>(UsefulInterval(twice)), static_cast<double>(UsefulInterval(Need(6, 100))),
              1);
}

TEST(UsefulInterval, FastMotionMakesItShort) {
  KeyframeNeed need = Need(60, 120);
  need.image_speed = 1'000;
  EXPECT_EQ(UsefulInterval(need), 30'000);
  need.image_speed = 3'000;
  EXPECT_EQ(UsefulInterval(need), 10'000);
}

TEST(UsefulInterval, AFinerSensorSeesTheSameMotionInMorePixels) {
  KeyframeNeed need = Need(60, 120);
  need.image_speed = 2'000;
  need.image_width = 1280;
  EXPECT_EQ(UsefulInterval(need), 30'000);
}

TEST(UsefulInterval, IsNothingWhereNothingIsKnown) {
  EXPECT_EQ(UsefulInterval(Need(0, 0)), 0);
  KeyframeNeed need = Need(60, 120);
  need.image_speed = 0;
  EXPECT_EQ(UsefulInterval(need), 0);
  need = Need(60, 120);
  need.interval = 0;
  EXPECT_EQ(UsefulInterval(need), 0);
  need = Need(60, 120);
  need.random.setZero();
  EXPECT_EQ(UsefulInterval(need), 0);
}

TEST(UsefulInterval, HasALimitThatAMessageCanHold) {
  KeyframeNeed need = Need(1e9, 1e9);
  need.image_speed = 1e-6;
  EXPECT_EQ(UsefulInterval(need), 1'000'000);
}

}  // namespace
}  // namespace evit
