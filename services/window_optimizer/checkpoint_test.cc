#include "services/window_optimizer/checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace evit {
namespace {

Checkpoint Example() {
  Checkpoint c;
  c.t = 1'642'661'138'836'530;
  c.keyframe_epoch = 77;
  c.keyframe_seq = 12;
  c.state.T_map_body = {ExpSO3({0.1, -2, 0.3}), {1.0 / 3, -2, 1e-9}};
  c.state.velocity = {1, -0.5, 0.25};
  c.state.bias = {{0.001, 0.002, 0.003}, {0.01, 0.02, 0.03}};
  c.rate = {0, 0, 1.5};
  c.image_speed = 123.4;
  c.information = 3 * Matrix15d::Identity();
  c.information(2, 14) = 0.5;
  return c;
}

class CheckpointTest : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  std::string path_ = ::testing::TempDir() + "evit_checkpoint_" + std::to_string(::getpid());
};

TEST_F(CheckpointTest, ComesBackBitForBit) {
  EXPECT_FALSE(CheckpointFile(path_).Load());
  CheckpointFile(path_).Store(Example());
  const auto back = CheckpointFile(path_).Load();
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->t, Example().t);
  EXPECT_EQ(back->keyframe_epoch, 77);
  EXPECT_EQ(back->keyframe_seq, 12);
  EXPECT_EQ(back->state.T_map_body.p, Example().state.T_map_body.p);
  EXPECT_EQ(back->state.T_map_body.q.coeffs(), Example().state.T_map_body.q.coeffs());
  EXPECT_EQ(back->state.velocity, Example().state.velocity);
  EXPECT_EQ(back->state.bias.gyro, Example().state.bias.gyro);
  EXPECT_EQ(back->state.bias.accel, Example().state.bias.accel);
  EXPECT_EQ(back->rate, Example().rate);
  EXPECT_EQ(back->image_speed, 123.4);
  EXPECT_EQ(back->information, Example().information);
}

TEST_F(CheckpointTest, InvalidStatesAreNotLoaded) {
  Checkpoint bad = Example();
  bad.state.velocity.x() = std::nan("");
  CheckpointFile(path_).Store(bad);
  EXPECT_FALSE(CheckpointFile(path_).Load());
  bad = Example();
  bad.state.T_map_body.q.coeffs() *= 2;
  CheckpointFile(path_).Store(bad);
  EXPECT_FALSE(CheckpointFile(path_).Load());
}

TEST_F(CheckpointTest, PredictsAtConstantVelocityAndRate) {
  const BodyState later = Example().After(200'000);
  EXPECT_LT((later.T_map_body.p - Example().state.T_map_body.p - Eigen::Vector3d(0.2, -0.1, 0.05)).norm(),
            1e-12);
  EXPECT_NEAR(AngularDistance(later.T_map_body.q, Example().state.T_map_body.q), 0.3, 1e-9);
}

}  // namespace
}  // namespace evit
