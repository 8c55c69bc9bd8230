#include "tools/monitor/page_audience.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "common/service/status_reporter.h"
#include "tests/helpers/sample_messages.h"
#include "tools/monitor/page_frames.h"

namespace evit::monitor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class PageAudienceTest : public ::testing::Test {
 protected:
  std::vector<FramePtr> Frames(ClientId client) {
    std::vector<FramePtr> frames;
    while (FramePtr frame = page_.Next(client)) frames.push_back(frame);
    return frames;
  }
  static FrameKind KindOf(const FramePtr& frame) {
    std::uint32_t kind = 0;
    std::memcpy(&kind, frame->data(), sizeof kind);
    return static_cast<FrameKind>(kind);
  }
  static std::vector<FrameKind> KindsOf(const std::vector<FramePtr>& frames) {
    std::vector<FrameKind> kinds;
    for (const FramePtr& frame : frames) kinds.push_back(KindOf(frame));
    return kinds;
  }

  PageAudience page_{[](ClientId) {}, [](const PageOrder&) { return std::string(); }};
};

TEST_F(PageAudienceTest, OneWhoComesLateGetsThePastAndTheNewestPicture) {
  ASSERT_TRUE(page_.WantsPicture());  // although nobody looks
  page_.OnPicture(Sample<keyframe_t>(), {});
  EXPECT_FALSE(page_.WantsPicture());  // not again within the same second
  page_.OnWindow(Sample<window_state_t>(), -1);
  page_.OnPose(Sample<body_pose_t>());
  page_.Connected(1, PageAudience::kProtocol);
  EXPECT_THAT(KindsOf(Frames(1)), ElementsAre(FrameKind::kPose, FrameKind::kHistory, FrameKind::kPicture));
}

TEST_F(PageAudienceTest, AViewerHearsHowLateItsPictureWas) {
  MapStore map;
  LatencyMeter latency;
  page_.SetPipeline(&map, &latency);
  page_.Connected(1, PageAudience::kProtocol);
  Frames(1);
  const std::int64_t now = HostTime();
  constexpr std::int64_t kSensorAhead = 5'000'000;
  for (const std::int64_t ago : {1'500'000, 10'000}) latency.AddData(now - ago + kSensorAhead, now - ago);
  const auto drawn = [&](std::int64_t utime) {
    page_.Received(1, R"({"order":"drawn","utime":)" + std::to_string(utime) + "}");
    return Frames(1);
  };
  const auto answer = drawn(now - 80'000 + kSensorAhead);
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_THAT(std::string(answer[0]->text()), HasSubstr("\"picture_ms\":"));
  const std::string text(answer[0]->text());
  EXPECT_GE(std::stod(text.substr(text.find("ms\":") + 4)), 80);
  EXPECT_TRUE(drawn(0).empty());  // the viewer does not tell which picture
}

TEST_F(PageAudienceTest, AMapComesInPiecesThatSayHowManyFollow) {
  MapStore map;
  LatencyMeter latency;
  map.Set(std::vector<Eigen::Vector3f>(40'000, Eigen::Vector3f::Ones()));
  page_.SetPipeline(&map, &latency);
  page_.Connected(1, PageAudience::kProtocol);
  const std::vector<FramePtr> frames = Frames(1);
  ASSERT_EQ(frames.size(), 3U);
  std::uint32_t next = 0;
  for (const FramePtr& frame : frames) {
    std::uint32_t head[5];
    std::memcpy(head, frame->data(), sizeof head);
    EXPECT_EQ(head[0], static_cast<std::uint32_t>(FrameKind::kMap));
    EXPECT_EQ(head[2], next);
    EXPECT_EQ(head[4], 40'000U);
    EXPECT_EQ(frame->size(), sizeof head + 12 * head[3]);
    next += head[3];
  }
  EXPECT_EQ(next, 40'000U);
}

TEST_F(PageAudienceTest, AModeIsToldWhenItChangesAndNotWithEachKeyframe) {
  page_.Connected(1, PageAudience::kProtocol);
  tracker_mode_t mode = Sample<tracker_mode_t>();
  page_.OnMode(mode);
  EXPECT_EQ(Frames(1).size(), 1U);
  ++mode.keyframe_seq;
  mode.image_speed += 10;
  page_.OnMode(mode);
  EXPECT_TRUE(Frames(1).empty());
  mode.reason += "!";
  page_.OnMode(mode);
  EXPECT_EQ(Frames(1).size(), 1U);
}

}  // namespace
}  // namespace evit::monitor
