#include "common/tracking/anchor.h"

#include <gtest/gtest.h>

#include "tests/helpers/synthetic_scene.h"

namespace evit {
namespace {

constexpr double kGravity = 9.81, kMaxSpeed = 6;
constexpr Utime kBegin = 1'000'000;

TEST(Anchor, MovesWithTheBodyForAWhileThenTurnsWithItAlone) {
  const synthetic::Motion motion;
  const BodyState start = motion.State(ToSeconds(kBegin));
  Anchor anchor;
  anchor.Start(start.T_map_body, start.velocity);
  const auto move = [&](Utime from, Utime to) {
    anchor.Move(motion.Samples(from, to, {}), {}, kGravity, kMaxSpeed);
  };
  move(kBegin, kBegin + 1'000'000);
  const SE3 truth = motion.State(ToSeconds(kBegin + 1'000'000)).T_map_body;
  EXPECT_LT((anchor.pose().p - truth.p).norm(), 0.01);
  EXPECT_LT(AngularDistance(anchor.pose().q, truth.q), 1e-3);
  move(kBegin + 1'000'000, kBegin + 2'000'000);
  const Eigen::Vector3d last = anchor.pose().p;
  move(kBegin + 2'000'000, kBegin + 3'000'000);
  EXPECT_EQ(anchor.pose().p, last);
  EXPECT_EQ(anchor.velocity(), Eigen::Vector3d::Zero());
  EXPECT_LT(AngularDistance(anchor.pose().q, motion.State(ToSeconds(kBegin + 3'000'000)).T_map_body.q), 3e-3);
}

TEST(Anchor, StaysWhereItIsWhileItsVelocityIsUnknown) {
  const synthetic::Motion motion;
  const SE3 start = motion.State(ToSeconds(kBegin)).T_map_body;
  Anchor anchor;
  anchor.Start(start);
  anchor.Move(motion.Samples(kBegin, kBegin + 500'000, {}), {}, kGravity, kMaxSpeed);
  EXPECT_EQ(anchor.pose().p, start.p);
  EXPECT_GT(AngularDistance(anchor.pose().q, start.q), 0.01);
}

TEST(Anchor, DoesNotFollowAReadingNoBodyCouldCause) {
  const synthetic::Motion motion;
  const BodyState start = motion.State(ToSeconds(kBegin));
  Anchor anchor;
  anchor.Start(start.T_map_body, start.velocity);
  std::vector<ImuSample> samples = motion.Samples(kBegin, kBegin + 100'000, {});
  for (ImuSample& s : samples) s.accel.x() = 300;
  anchor.Move(samples, {}, kGravity, kMaxSpeed);
  EXPECT_EQ(anchor.pose().p, start.T_map_body.p);
}

}  // namespace
}  // namespace evit
