#include "services/window_optimizer/pose_hint_inbox.h"

#include <gtest/gtest.h>

#include "common/bus/codec.h"
#include "common/bus/memory_bus.h"

namespace evit {
namespace {

class PoseHintInboxTest : public ::testing::Test {
 protected:
  void Hint(std::int64_t seq, double x) {
    body_pose_t message{};
    message.seq = seq;
    message.epoch = 4;
    message.position[0] = x;
    message.orientation[2] = 0.6, message.orientation[3] = 0.8;
    std::vector<std::uint8_t> bytes;
    EncodeTo(message, &bytes);
    inbox_.OnMessage(bytes.data(), bytes.size());
  }

  std::unique_ptr<Bus> bus_ = OpenMemoryBus(MakeMemoryHub());
  StatusReporter status_{bus_.get(), Channels(), "window_optimizer", 1};
  PoseHintInbox inbox_{&status_};
};

TEST_F(PoseHintInboxTest, TheNewestHintIsTakenOnce) {
  EXPECT_FALSE(inbox_.Take().has_value());
  Hint(0, 1);
  Hint(1, 2);
  const std::optional<SE3> pose = inbox_.Take();
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->p.x(), 2);
  EXPECT_NEAR(pose->q.z(), 0.6, 1e-12);
  EXPECT_FALSE(inbox_.Take().has_value());
}

TEST_F(PoseHintInboxTest, AHintHeardTwiceIsOneHint) {
  Hint(0, 1);
  inbox_.Take();
  Hint(0, 1);
  EXPECT_FALSE(inbox_.Take().has_value());
  EXPECT_EQ(status_.Counter("POSE_HINT.duplicate"), 1);
}

TEST_F(PoseHintInboxTest, RubbishIsCounted) {
  const std::vector<std::uint8_t> rubbish(100, 0xab);
  inbox_.OnMessage(rubbish.data(), rubbish.size());
  EXPECT_FALSE(inbox_.Take().has_value());
  EXPECT_EQ(status_.Counter("POSE_HINT.invalid"), 1);
}

}  // namespace
}  // namespace evit
