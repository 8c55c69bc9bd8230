#include "services/window_optimizer/keyframe_inbox.h"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/sample_messages.h"

namespace evit {
namespace {

class KeyframeInboxTest : public ::testing::Test {
 protected:
  static Camera SixteenSquared() {
    Camera camera;
    camera.width = camera.height = 16;
    return camera;
  }
  static keyframe_t Keyframe(std::int8_t encoding, int side) {
    keyframe_t keyframe = Sample<keyframe_t>(3);
    keyframe.encoding = encoding;
    keyframe.width = keyframe.height = side;
    keyframe.surface_size = side * side;
    keyframe.surface.assign(keyframe.surface_size, 128);
    return keyframe;
  }
  static bool Takes(KeyframeInbox* inbox, const keyframe_t& keyframe) {
    std::vector<std::uint8_t> bytes;
    EncodeTo(keyframe, &bytes);
    return inbox->Decode(bytes.data(), bytes.size()).has_value();
  }
  // What STATUS says.
  service_status_t Status() {
    std::vector<service_status_t> statuses;
    std::unique_ptr<Bus> listener = OpenMemoryBus(hub_);
    test::Keep(listener.get(), Channels().status, &statuses);
    status_.Publish();
    listener->Poll(0);
    return statuses.back();
  }

  std::shared_ptr<MemoryHub> hub_ = MakeMemoryHub();
  std::unique_ptr<Bus> bus_ = OpenMemoryBus(hub_);
  StatusReporter status_{bus_.get(), Channels(), "window_optimizer", 1};
  KeyframeInbox surfaces_{&status_, keyframe_t::TIME_SURFACE, SixteenSquared()};
  KeyframeInbox counts_{&status_, keyframe_t::EVENT_COUNT, SixteenSquared()};
};

TEST_F(KeyframeInboxTest, TakesWhatTheMethodNeeds) {
  EXPECT_TRUE(Takes(&surfaces_, Keyframe(keyframe_t::TIME_SURFACE, 16)));
  EXPECT_TRUE(Takes(&counts_, Keyframe(keyframe_t::EVENT_COUNT, 16)));
  EXPECT_EQ(status_.Counter("KEYFRAME.invalid"), 0);
}

TEST_F(KeyframeInboxTest, RubbishIsCountedWithoutFailing) {
  const std::vector<std::uint8_t> rubbish(300, 0xab);
  EXPECT_FALSE(surfaces_.Decode(rubbish.data(), rubbish.size()).has_value());
  EXPECT_EQ(status_.Counter("KEYFRAME.invalid"), 1);
  EXPECT_NE(status_.state(), "failed");
}

TEST_F(KeyframeInboxTest, AnotherCamerasKeyframesFailAndPointToTheRig) {
  EXPECT_FALSE(Takes(&surfaces_, Keyframe(keyframe_t::TIME_SURFACE, 8)));
  EXPECT_EQ(status_.Counter("KEYFRAME.invalid"), 1);
  const service_status_t status = Status();
  EXPECT_EQ(status.state, "failed");
  EXPECT_NE(status.detail.find("8x8"), std::string::npos);
  EXPECT_NE(status.detail.find("--rig"), std::string::npos);
}

TEST_F(KeyframeInboxTest, AnotherMethodsKeyframesFailAndPointToTheSettings) {
  EXPECT_FALSE(Takes(&surfaces_, Keyframe(keyframe_t::EVENT_COUNT, 16)));
  EXPECT_NE(Status().detail.find("--config"), std::string::npos);
  EXPECT_FALSE(Takes(&counts_, Keyframe(keyframe_t::TIME_SURFACE, 16)));
  EXPECT_NE(Status().detail.find("--config"), std::string::npos);
  EXPECT_EQ(status_.Counter("KEYFRAME.invalid"), 2);
}

}  // namespace
}  // namespace evit
