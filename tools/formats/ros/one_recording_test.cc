#include "tools/formats/ros/one_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Utime kSecond = kMicrosPerSecond, kStart = 1'600'000'000 * kSecond;
const TakenTopics kTaken{"/events", "/imu", "/pose"};

BagPart Part(const std::string& file, const std::string& topic, double begin, double end) {
  return {file,
          {{topic, {kStart + static_cast<Utime>(1e6 * begin), kStart + static_cast<Utime>(1e6 * end)}}}};
}

void ExpectRefused(const std::vector<BagPart>& parts, const std::string& first, const std::string& second) {
  EXPECT_THAT([&] { RequireOneRecording(parts, kTaken); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr(first), HasSubstr(second), HasSubstr("different recordings"))));
}

TEST(RequireOneRecording, PartsThatASplitLeavesBelongTogether) {
  RequireOneRecording({Part("b", "/events", 10.1, 20), Part("a", "/events", 0, 10)}, kTaken);
  RequireOneRecording({Part("a", "/events", 0, 10.2), Part("b", "/events", 10, 20)}, kTaken);
  // Streams of their own files: another topic may begin earlier and end later.
  RequireOneRecording({Part("e", "/events", 0, 10), Part("i", "/imu", -5, 30), Part("p", "/pose", 2, 8)},
                      kTaken);
  // What is not taken does not count, nor a file without messages.
  RequireOneRecording({Part("e", "/events", 0, 10), Part("o", "/other", 500, 600), {"empty", {}}}, kTaken);
}

TEST(RequireOneRecording, DifferentRecordingsAreRefusedByName) {
  ExpectRefused({Part("a.bag", "/events", 0, 10), Part("b.bag", "/events", 100, 110)}, "a.bag", "b.bag");
  ExpectRefused({Part("a.bag", "/events", 0, 10), Part("copy.bag", "/events", 0, 10)}, "a.bag", "copy.bag");
  ExpectRefused({Part("a.bag", "/events", 0, 10), Part("b.bag", "/events", 4, 20)}, "a.bag", "b.bag");
  ExpectRefused({Part("e.bag", "/events", 0, 10), Part("i.bag", "/imu", 100, 110)}, "i.bag", "e.bag");
  ExpectRefused({Part("e.bag", "/events", 100, 110), Part("p.bag", "/pose", 0, 10)}, "p.bag", "e.bag");
  ExpectRefused({Part("i.bag", "/imu", 0, 10), Part("i2.bag", "/imu", 1, 11)}, "i.bag", "i2.bag");
}

}  // namespace
}  // namespace evit::formats
