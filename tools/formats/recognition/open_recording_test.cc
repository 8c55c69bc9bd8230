#include "tools/formats/recognition/open_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(OpenRecording, WhatIsNotRecognisedIsSaidWithWhatWouldBe) {
  const TemporaryFolder folder("recognition");
  const std::string path = folder.Write("a.raw",
                                        "\x7f"
                                        "ELF something else");
  EXPECT_THAT([&] { OpenRecording({path}); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr(path), HasSubstr("Metavision RAW"))));
  EXPECT_THAT([&] { OpenRecording({folder.File("none")}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no such file")));
}

TEST(MeasureSize, TheSmallestKnownSensorThatHoldsAllEventsIsTaken) {
  const TemporaryFolder folder("recognition");
  std::string words = "% evt 3.0\n";
  for (const unsigned word : {0x8001U, 0x6001U, 0x0000U | 250U, 0x2000U | 300U, 0x8001U}) {
    words += static_cast<char>(word & 0xFF);
    words += static_cast<char>(word >> 8);
  }
  const auto recording = OpenRecording({folder.Write("some.name", words)});
  int width = 0, height = 0;
  MeasureSize(recording.get(), &width, &height);
  EXPECT_EQ(width, 320);
  EXPECT_EQ(height, 320);
}

}  // namespace
}  // namespace evit::formats
