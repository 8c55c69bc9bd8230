#include "services/window_optimizer/checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

namespace evit {
namespace {

Checkpoint Example() {
  Checkpoint c;
  c.t = 1'642'661'138'836'530;
  c.state.T_world_body = {ExpSO3({0.1, -2, 0.3}), {1.0 / 3, -2, 1e-9}};
  c.state.velocity = {1, -0.5, 0.25};
  c.state.bias = {{0.001, 0.002, 0.003}, {0.01, 0.02, 0.03}};
  c.rate = {0, 0, 1.5};
  return c;
}

class CheckpointTest : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }
  std::string path_ = ::testing::TempDir() + "evit_checkpoint_" + std::to_string(::getpid());
};

TEST_F(CheckpointTest, ComesBackBitForBit) {
  ASSERT_TRUE(SaveCheckpoint(path_, Example()));
  const auto back = LoadCheckpoint(path_);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->t, Example().t);
  EXPECT_EQ(back->state.T_world_body.p, Example().state.T_world_body.p);
  EXPECT_EQ(back->state.T_world_body.q.coeffs(), Example().state.T_world_body.q.coeffs());
  EXPECT_EQ(back->state.bias.accel, Example().state.bias.accel);
  EXPECT_EQ(back->rate, Example().rate);
}

TEST_F(CheckpointTest, NothingHalfOrForeignIsTaken) {
  EXPECT_FALSE(LoadCheckpoint(path_ + ".absent"));
  ASSERT_TRUE(SaveCheckpoint(path_, Example()));
  std::ifstream file(path_);
  const std::string whole((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2),
                                  whole.substr(0, whole.size() - 5), "x" + whole, std::string("1 2 3")}) {
    std::ofstream(path_) << text;
    EXPECT_FALSE(LoadCheckpoint(path_)) << text;
  }
  EXPECT_FALSE(SaveCheckpoint("/nonexistent/folder/checkpoint", Example()));
}

TEST_F(CheckpointTest, GoesOnAtConstantVelocityAndRate) {
  const BodyState later = Example().After(200'000);
  EXPECT_LT((later.T_world_body.p - Example().state.T_world_body.p - Eigen::Vector3d(0.2, -0.1, 0.05)).norm(),
            1e-12);
  EXPECT_NEAR(AngularDistance(later.T_world_body.q, Example().state.T_world_body.q), 0.3, 1e-9);
}

}  // namespace
}  // namespace evit
