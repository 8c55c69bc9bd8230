#include "tools/formats/prophesee/raw_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "tests/helpers/all_events.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/prophesee/evt3_writer.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(RawRecording, WhatEvt3WriterWritesIsReadBack) {
  const TemporaryFolder folder("raw");
  EventArray events;
  std::mt19937 rng(3);
  for (Utime t = 1'600'000'000'000'123; events.size() < 200'000; t += rng() % 400)  // 40 s: the stamps wrap
    events.push_back(t, rng() % 1280, rng() % 720, rng() % 2);
  Evt3Writer writer(folder.File("a.raw"), 1280, 720, events.t.front());
  writer.Append(events);
  EXPECT_FALSE(std::filesystem::exists(folder.File("a.raw")));
  writer.Close();
  RawRecording recording(folder.File("a.raw"));
  EXPECT_EQ(recording.info().format, "Metavision RAW, EVT 3.0");
  EXPECT_EQ(recording.info().width, 1280);
  EXPECT_EQ(recording.info().height, 720);
  const EventArray read = AllEvents(&recording, 1280, 720);
  for (Utime& t : events.t) t -= 1'600'000'000'000'123;
  EXPECT_EQ(read.t, events.t);
  EXPECT_EQ(read.x, events.x);
  EXPECT_EQ(read.y, events.y);
  EXPECT_EQ(read.p, events.p);
}

TEST(RawRecording, HeadersNameEncodingAndSize) {
  const TemporaryFolder folder("raw");
  const struct {
    std::string header, format;
    int width, height;
  } cases[] = {{"% evt 2.0\n% plugin_name hal_plugin_gen3_fx3\n", "Metavision RAW, EVT 2.0", 640, 480},
               {"% format EVT21;height=320;width=320;endianness=little\n% end\n",
                "Metavision RAW, EVT 2.1 (little-endian)", 320, 320},
               {"% format EVT21;endianness=legacy\n% sensor_name IMX636\n% end\n",
                "Metavision RAW, EVT 2.1 (upper half first)", 1280, 720},
               {"% evt 3.0\r\n% geometry 640x480\r\n", "Metavision RAW, EVT 3.0", 640, 480},
               {"% Data file containing CD events.\n% Version 2\n% Height 240\n% Width 304\n\x0C\x08",
                "Metavision DAT", 304, 240}};
  for (const auto& c : cases) {
    const std::string path = folder.Write("a.raw", c.header + std::string(16, '\0'));
    EXPECT_TRUE(RawRecording::Recognises(path));
    const RecordingInfo info = RawRecording(path).info();
    EXPECT_EQ(info.format, c.format);
    EXPECT_EQ(info.width, c.width) << c.header;
    EXPECT_EQ(info.height, c.height) << c.header;
  }
}

TEST(RawRecording, OtherFilesAreRefused) {
  const TemporaryFolder folder("raw");
  EXPECT_FALSE(RawRecording::Recognises(folder.Write("a.txt", "0.1 2 3 1\n")));
  EXPECT_FALSE(RawRecording::Recognises(folder.Write("empty", "")));
  for (const auto& [header, why] : {std::pair("% format EVT4\n% end\n1234567", "its encoding is EVT4"),
                                    std::pair("% what 1\n\x01\x02zz", "names no encoding"),
                                    std::pair("% evt 3.0\n% endianness big\n% end\n", "big-endian"),
                                    std::pair("% no end of line", "does not end")}) {
    const std::string path = folder.Write("a.raw", header);
    EXPECT_THAT([&] { RawRecording{path}; }, ThrowsMessage<std::runtime_error>(HasSubstr(path)));
    EXPECT_THAT([&] { RawRecording{path}; }, ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  }
}

// Counts and sums by a plain decoder of the published format, written for this test alone.
TEST(RawRecording, ARealEvt2FileIsReadWhole) {
  const std::string path = SharedFile("formats/evt2.raw");
  if (path.empty()) GTEST_SKIP() << "no recordings (EVIT_SHARED_DATA)";
  RawRecording recording(path);
  EXPECT_EQ(recording.info().width, 640);
  EXPECT_EQ(recording.info().height, 480);
  DropCounts dropped;
  const EventArray e = AllEvents(&recording, 640, 480, &dropped);
  EXPECT_EQ(dropped.total(), 0);
  EXPECT_EQ(e.size(), 521'252U);
  EXPECT_EQ(e.t.front(), 913'716'224);
  EXPECT_EQ(e.t.back(), 913'812'095);
  EXPECT_EQ(std::accumulate(e.t.begin(), e.t.end(), Utime{0}), 476'298'094'656'969);
  EXPECT_EQ(std::accumulate(e.x.begin(), e.x.end(), 0), 128'979'953);
  EXPECT_EQ(std::accumulate(e.y.begin(), e.y.end(), 0), 216'346'680);
  EXPECT_EQ(std::accumulate(e.p.begin(), e.p.end(), 0), 185'861);
}

}  // namespace
}  // namespace evit::formats
