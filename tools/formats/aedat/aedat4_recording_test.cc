#include "tools/formats/aedat/aedat4_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include <cmath>
#include <cstring>

#include "tests/helpers/all_events.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

template <typename Number>
std::string Bytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// A message of one table with a vector as its only field.
std::string Message(const std::string& identifier, std::uint32_t n, const std::string& items) {
  std::string body = Bytes<std::uint32_t>(16) + identifier;  // root at 4 + 16
  body += Bytes<std::uint16_t>(6) + Bytes<std::uint16_t>(8) + Bytes<std::uint16_t>(4) +
          std::string(2, '\0');                              // vtable at 12
  body += Bytes<std::int32_t>(8) + Bytes<std::uint32_t>(4);  // table at 20, its vector follows
  body += Bytes<std::uint32_t>(n) + items;
  return Bytes(static_cast<std::uint32_t>(body.size())) + body;
}

std::string Event(std::int64_t t, std::int16_t x, std::int16_t y, bool on) {
  return Bytes(t) + Bytes(x) + Bytes(y) + std::string(1, on ? '\1' : '\0') + std::string(3, '\0');
}

std::string Header(const std::string& xml, std::int32_t compression) {
  std::string body = Bytes<std::uint32_t>(20) + "IOHE";  // root at 4 + 20
  body += Bytes<std::uint16_t>(10) + Bytes<std::uint16_t>(12) + Bytes<std::uint16_t>(4) +
          Bytes<std::uint16_t>(0) + Bytes<std::uint16_t>(8) +
          std::string(2, '\0');  // vtable at 12: compression, (position), list
  body += Bytes<std::int32_t>(12) + Bytes(compression) + Bytes<std::uint32_t>(4);  // table at 24
  body += Bytes(static_cast<std::uint32_t>(xml.size())) + xml;
  return "#!AER-DAT4.0\r\n" + Bytes(static_cast<std::uint32_t>(body.size())) + body;
}

constexpr char kXml[] =
    "<dv version=\"2.0\"><node name=\"outInfo\" path=\"/mainloop/Recorder/outInfo/\">"
    "<node name=\"3\"><attr key=\"typeIdentifier\" type=\"string\">EVTS</attr><node name=\"info\">"
    "<attr key=\"sizeX\" type=\"int\">346</attr><attr key=\"sizeY\" type=\"int\">260</attr>"
    "<attr key=\"source\" type=\"string\">DAVIS346_7</attr></node></node></node></dv>";

std::string Packet(std::int32_t stream, const std::string& contents) {
  return Bytes(stream) + Bytes(static_cast<std::uint32_t>(contents.size())) + contents;
}

std::string Lz4(const std::string& in) {
  std::string out(LZ4F_compressFrameBound(in.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), in.data(), in.size(), nullptr));
  return out;
}

TEST(Aedat4Recording, EventsOfCompressedAndPlainPacketsAreRead) {
  const TemporaryFolder folder("aedat4");
  const std::string first = Message(
      "EVTS", 2, Event(1'600'000'000'000'000, 345, 0, true) + Event(1'600'000'000'000'005, 1, 259, false));
  const std::string second = Message(
      "EVTS", 2, Event(1'600'000'000'000'009, 346, 0, true) + Event(1'600'000'000'000'010, 7, 8, true));
  const auto file = [&](int compression, const auto& pack) {
    return folder.Write("a.aedat4", Header(kXml, compression) + Packet(3, pack(first)) +
                                        Packet(0, pack("another stream")) + Packet(3, pack(second)) +
                                        Packet(3, pack(first)).substr(0, 20));  // cut off
  };
  for (const int compression : {0, 1}) {
    const std::string path =
        file(compression, [&](const std::string& s) { return compression == 0 ? s : Lz4(s); });
    ASSERT_TRUE(Aedat4Recording::Recognises(path));
    Aedat4Recording recording(path);
    EXPECT_EQ(recording.info().sensor, "DAVIS346_7");
    EXPECT_EQ(recording.info().width, 346);
    EXPECT_EQ(recording.info().height, 260);
    DropCounts dropped;
    const EventArray e = AllEvents(&recording, 346, 260, &dropped);
    EXPECT_EQ(e.t, (std::vector<Utime>{1'600'000'000'000'000, 1'600'000'000'000'005, 1'600'000'000'000'010}));
    EXPECT_EQ(e.x, (std::vector<std::uint16_t>{345, 1, 7}));
    EXPECT_EQ(e.y, (std::vector<std::uint16_t>{0, 259, 8}));
    EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 1}));
    EXPECT_EQ(dropped.outside, 1);
    EXPECT_TRUE(dropped.cut_off);
    EXPECT_THAT(DropText(dropped, "events"), HasSubstr("is cut off"));
    EXPECT_TRUE(recording.Streams().imu.empty());
  }
  const std::string damaged = file(1, [](const std::string& s) { return s; });  // not LZ4
  Aedat4Recording recording(damaged);
  EXPECT_THAT([&] { AllEvents(&recording, 346, 260); },
              ThrowsMessage<std::runtime_error>(HasSubstr(damaged)));
}

TEST(Aedat4Recording, ARealFileOfACameraAtRestIsReadWhole) {
  const std::string path = SharedFile("formats/davis346.aedat4");
  if (path.empty()) GTEST_SKIP() << "no recordings (EVIT_SHARED_DATA)";
  Aedat4Recording recording(path);
  EXPECT_EQ(recording.info().format, "AEDAT 4.0, LZ4");
  EXPECT_EQ(recording.info().width, 346);
  EXPECT_EQ(recording.info().height, 260);
  DropCounts dropped;
  const EventArray e = AllEvents(&recording, 346, 260, &dropped);
  EXPECT_EQ(e.size(), 6676U);
  EXPECT_FALSE(dropped.cut_off);
  EXPECT_EQ(dropped.total(), 0);
  EXPECT_NEAR(1e-6 * static_cast<double>(e.t.back() - e.t.front()), 0.170, 0.001);
  const ImportStreams streams = recording.Streams();
  ASSERT_GT(streams.imu.size(), 100U);
  const double seconds = 1e-6 * static_cast<double>(streams.imu.back().t - streams.imu.front().t);
  EXPECT_NEAR(static_cast<double>(streams.imu.size() - 1) / seconds, 1001, 1);
  Eigen::Vector3d accel = Eigen::Vector3d::Zero(), gyro = Eigen::Vector3d::Zero();
  for (const ImuSample& s : streams.imu) accel += s.accel, gyro += s.gyro;
  EXPECT_NEAR((accel / static_cast<double>(streams.imu.size())).norm(), 9.81, 0.5);  // at rest
  EXPECT_LT((gyro / static_cast<double>(streams.imu.size())).norm(), 0.1);
}

std::string Stream(int id, const std::string& type, const std::string& source) {
  return "<node name=\"" + std::to_string(id) + "\"><attr key=\"typeIdentifier\" type=\"string\">" + type +
         "</attr><node name=\"info\"><attr key=\"sizeX\" type=\"int\">346</attr><attr key=\"sizeY\" "
         "type=\"int\">260</attr><attr key=\"source\" type=\"string\">" +
         source + "</attr></node></node>";
}

std::string Streams(const std::string& list) {
  return "<dv version=\"2.0\"><node name=\"outInfo\" path=\"/mainloop/Recorder/outInfo/\">" + list +
         "</node></dv>";
}

// A file of two cameras: which is meant cannot be told.
TEST(Aedat4Recording, OfSeveralCamerasOneIsChosen) {
  const TemporaryFolder folder("aedat4");
  const std::string left = Message("EVTS", 1, Event(10, 1, 2, true)),
                    right = Message("EVTS", 1, Event(11, 3, 4, true));
  const std::string path =
      folder.Write("a.aedat4", Header(Streams(Stream(0, "EVTS", "A") + Stream(2, "EVTS", "B")), 0) +
                                   Packet(0, left) + Packet(2, right));
  EXPECT_THAT([&] { Aedat4Recording{path}; },
              ThrowsMessage<std::runtime_error>(HasSubstr("--events-topic: 0 (A), 2 (B)")));
  EXPECT_THAT([&] { Aedat4Recording(path, "C"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("0 (A), 2 (B)")));
  for (const char* name : {"B", "2"}) {
    Aedat4Recording recording(path, name);
    EXPECT_EQ(recording.info().sensor, "B");
    EXPECT_EQ(AllEvents(&recording, 346, 260).t, std::vector<Utime>{11});
  }
}

// The root's vector of one table: stamp 7 us, 1 g along x, 180 deg/s about z.
std::string OneImuSample() {
  std::string body = Bytes<std::uint32_t>(16) + "IMUS";
  body += Bytes<std::uint16_t>(6) + Bytes<std::uint16_t>(8) + Bytes<std::uint16_t>(4) + std::string(2, '\0');
  body += Bytes<std::int32_t>(8) + Bytes<std::uint32_t>(4);     // at 16; its vector at 24
  body += Bytes<std::uint32_t>(1) + Bytes<std::uint32_t>(28);   // the sample's table at 56
  body += Bytes<std::uint16_t>(20) + Bytes<std::uint16_t>(40);  // its vtable at 32
  for (const int offset : {8, 0, 16, 20, 24, 28, 32, 36}) body += Bytes(static_cast<std::uint16_t>(offset));
  body += std::string(4, '\0') + Bytes<std::int32_t>(24) + std::string(4, '\0') + Bytes<std::int64_t>(7);
  for (const float value : {1.F, 0.F, 0.F, 0.F, 0.F, 180.F}) body += Bytes(value);
  return Bytes(static_cast<std::uint32_t>(body.size())) + body;
}

TEST(Aedat4Recording, TheOnlyImuIsTakenWhateverItsName) {
  const TemporaryFolder folder("aedat4");
  const auto imu = [&](const std::string& streams) {
    return Aedat4Recording(folder.Write("a.aedat4", Header(Streams(streams), 0) +
                                                        Packet(0, Message("EVTS", 1, Event(10, 1, 2, true))) +
                                                        Packet(1, OneImuSample())))
        .Streams()
        .imu;
  };
  for (const char* source : {"A", "", "an IMU of its own"}) {
    const std::vector<ImuSample> samples = imu(Stream(0, "EVTS", "A") + Stream(1, "IMUS", source));
    ASSERT_EQ(samples.size(), 1U) << source;
    EXPECT_EQ(samples[0].t, 7);
    EXPECT_NEAR(samples[0].accel.x(), 9.80665, 1e-5);
    EXPECT_NEAR(samples[0].gyro.z(), 3.14159265, 1e-6);
  }
}

// Opened for its IMU alone, which camera's events are meant is no question; which IMU is one.
TEST(Aedat4Recording, ForItsImuAloneNoCameraIsChosen) {
  const TemporaryFolder folder("aedat4");
  const auto file = [&](const std::string& imus) {
    return folder.Write("a.aedat4",
                        Header(Streams(Stream(0, "EVTS", "A") + Stream(2, "EVTS", "B") + imus), 0) +
                            Packet(0, Message("EVTS", 1, Event(10, 1, 2, true))) + Packet(1, OneImuSample()));
  };
  const std::string one = file(Stream(1, "IMUS", "A"));
  Aedat4Recording recording(one, "", "", false);
  EXPECT_EQ(recording.Streams().imu.size(), 1U);
  EXPECT_THROW(recording.Events(346, 260), std::runtime_error);
  const std::string two = file(Stream(1, "IMUS", "A") + Stream(3, "IMUS", "B"));
  EXPECT_THAT([&] { Aedat4Recording(two, "", "", false); },
              ThrowsMessage<std::runtime_error>(HasSubstr("--imu-topic: 1 (A), 3 (B)")));
  EXPECT_EQ(Aedat4Recording(two, "", "A", false).Streams().imu.size(), 1U);
}

}  // namespace
}  // namespace evit::formats
