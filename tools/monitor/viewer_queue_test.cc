#include "tools/monitor/viewer_queue.h"

#include <gtest/gtest.h>

#include <string>

namespace evit::monitor {
namespace {

TEST(ViewerQueue, KeepsOnlyTheNewestOfAName) {
  ViewerQueue queue;
  queue.Replace("pose", TextFrame("old"));
  queue.Replace("pose", TextFrame("new"));
  queue.Replace("mode", TextFrame("tracking"));
  EXPECT_EQ(queue.dropped(), 1);
  EXPECT_EQ(queue.Next()->text(), "tracking");
  EXPECT_EQ(queue.Next()->text(), "new");
  EXPECT_EQ(queue.Next(), nullptr);
  EXPECT_FALSE(queue.ready());
}

TEST(ViewerQueue, ASeriesKeepsItsOrderAndItsNewest) {
  ViewerQueue queue;
  for (int i = 0; i < 600; ++i) queue.Append(TextFrame(std::to_string(i)));
  EXPECT_EQ(queue.dropped(), 88);
  for (int i = 88; i < 600; ++i) ASSERT_EQ(queue.Next()->text(), std::to_string(i));
  EXPECT_EQ(queue.Next(), nullptr);
}

TEST(ViewerQueue, AViewerThatDoesNotAcknowledgeGetsOnePictureAndNoMore) {
  ViewerQueue queue;
  ASSERT_TRUE(queue.wants_picture());
  queue.ReplacePicture(TextFrame("0"));
  EXPECT_FALSE(queue.wants_picture());
  ASSERT_NE(queue.Next(), nullptr);
  EXPECT_FALSE(queue.wants_picture());
  for (int i = 1; i < 1000; ++i) queue.ReplacePicture(TextFrame(std::to_string(i)));
  EXPECT_EQ(queue.Next(), nullptr);
  EXPECT_FALSE(queue.ready());
  EXPECT_EQ(queue.dropped(), 998);
  queue.Acknowledge();
  EXPECT_EQ(queue.Next()->text(), "999");
}

TEST(ViewerQueue, AcknowledgementsOfNothingGiveNoCredit) {
  ViewerQueue queue;
  for (int i = 0; i < 50; ++i) queue.Acknowledge();
  int sent = 0;
  for (int i = 0; i < 10; ++i) {
    queue.ReplacePicture(TextFrame("p"));
    sent += queue.Next() ? 1 : 0;
  }
  EXPECT_EQ(sent, 1);
}

TEST(ViewerQueue, SmallFramesOvertakeAPicture) {
  ViewerQueue queue;
  queue.ReplacePicture(TextFrame("picture"));
  queue.Append(TextFrame("state"));
  EXPECT_EQ(queue.Next()->text(), "state");
  EXPECT_EQ(queue.Next()->text(), "picture");
}

}  // namespace
}  // namespace evit::monitor
