#include "tools/formats/aedat/aedat_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/helpers/all_events.h"
#include "tests/helpers/temporary_folder.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}
template <typename Number>
std::string Bytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

TEST(AedatRecording, EventsAndImuOfJaerAreRead) {
  const TemporaryFolder folder("aedat");
  std::string file =
      "#!AER-DAT2.0\r\n# This is a raw AE data file - do not edit\r\n# AEChip: "
      "eu.seebetter.ini.chips.davis.DAVIS240C\r\n";
  const auto put = [&](std::uint32_t address, std::uint32_t t) { file += BigEndian(address) + BigEndian(t); };
  put(0U << 22 | 0U << 12 | 1U << 11, 100);  // bottom right, brighter
  put(179U << 22 | 239U << 12, 101);         // top left, darker
  put(1U << 10, 102);                        // external
  put(0x8000'0000U | 5U << 22, 102);         // a frame's pixel
  const std::int16_t values[] = {4096, 0, -4096, 77, 16384, -16384, 0};
  for (unsigned k = 0; k < 7; ++k)
    put(0x8000'0C00U | k << 28 | static_cast<std::uint32_t>(static_cast<std::uint16_t>(values[k])) << 12,
        103);
  put(0x8000'0C00U | 4U << 28, 104);  // a part of a sample: left out
  put(10U << 22 | 20U << 12, 105);
  AedatRecording recording(folder.Write("a.aedat", file));
  EXPECT_EQ(recording.info().format, "AEDAT 2.0");
  EXPECT_EQ(recording.info().width, 240);
  const EventArray e = AllEvents(&recording, 240, 180);
  EXPECT_EQ(e.t, (std::vector<Utime>{100, 101, 105}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{239, 0, 219}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{179, 0, 169}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 0}));
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.imu.size(), 1U);
  EXPECT_EQ(streams.imu[0].t, 103);
  EXPECT_TRUE(streams.imu[0].accel.isApprox(Eigen::Vector3d(9.80665, 0, -9.80665)));
  EXPECT_TRUE(streams.imu[0].gyro.isApprox(Eigen::Vector3d(500, -500, 0) * 3.14159265358979 / 180));
}

std::string Packet(std::int16_t type, std::int32_t size, std::int32_t overflow,
                   const std::vector<std::string>& items) {
  const auto n = static_cast<std::int32_t>(items.size());
  std::string out = Bytes(type) + Bytes<std::int16_t>(1) + Bytes(size) + Bytes<std::int32_t>(4) +
                    Bytes(overflow) + Bytes(n) + Bytes(n) + Bytes(n);
  for (const std::string& item : items) out += item;
  return out;
}

std::string Event(unsigned x, unsigned y, unsigned polarity, std::int32_t t, unsigned valid = 1) {
  return Bytes<std::uint32_t>(x << 17 | y << 2 | polarity << 1 | valid) + Bytes(t);
}

TEST(AedatRecording, PacketsOfCaerAreRead) {
  const TemporaryFolder folder("aedat");
  const std::string header = "#!AER-DAT3.1\r\n#Format: RAW\r\n#Source 1: DAVIS346\r\n#!END-HEADER\r\n";
  std::string imu = Bytes<std::uint32_t>(1) + Bytes<std::int32_t>(7);
  for (const float value : {1.F, 0.F, -1.F, 180.F, 0.F, 90.F, 25.F}) imu += Bytes(value);
  const std::string data = Packet(1, 8, 0, {Event(345, 259, 1, 5), Event(1, 1, 1, 6, 0), Event(0, 2, 0, 7)}) +
                           Packet(2, 40, 0, {std::string(40, '\1')}) + Packet(3, 36, 0, {imu}) +
                           Packet(1, 8, 1, {Event(3, 4, 1, 8)});
  AedatRecording recording(
      folder.Write("a.aedat", header + data + Packet(1, 8, 1, {Event(3, 4, 1, 9)}).substr(0, 33)));
  EXPECT_EQ(recording.info().format, "AEDAT 3.1");
  EXPECT_EQ(recording.info().width, 346);
  const EventArray e = AllEvents(&recording, 346, 260);
  EXPECT_EQ(e.t, (std::vector<Utime>{5, 7, (Utime{1} << 31) + 8}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{345, 0, 3}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{259, 2, 4}));
  const ImportStreams streams = recording.Streams();
  ASSERT_EQ(streams.imu.size(), 1U);
  EXPECT_TRUE(streams.imu[0].accel.isApprox(Eigen::Vector3d(9.80665, 0, -9.80665)));
  EXPECT_TRUE(streams.imu[0].gyro.isApprox(Eigen::Vector3d(3.14159265358979, 0, 1.570796326794897)));

  const std::string damaged = folder.Write("b.aedat", header + Packet(1, 8, -1, {Event(3, 4, 1, 8)}));
  AedatRecording other(damaged);
  EXPECT_THAT([&] { AllEvents(&other, 346, 260); }, ThrowsMessage<std::runtime_error>(HasSubstr(damaged)));
  EXPECT_THAT([&] { AedatRecording{folder.Write("c.aedat", "#!AER-DAT5.0\r\nabc")}; },
              ThrowsMessage<std::runtime_error>(HasSubstr("is AEDAT 5.0")));
}

// As the format's authors' own extractRetina128EventsFromAddr.m decodes it.
TEST(AedatRecording, ADvs128CountsColumnsFromTheRightAndMarksDarker) {
  const TemporaryFolder folder("aedat");
  std::string file = "#!AER-DAT2.0\r\n# AEChip: ch.unizh.ini.jaer.chip.retina.DVS128\r\n";
  file += BigEndian(127U << 8 | 0U << 1 | 0U) + BigEndian(10);  // top right, brighter
  file += BigEndian(0U << 8 | 127U << 1 | 1U) + BigEndian(11);  // bottom left, darker
  file += BigEndian(0x8000U) + BigEndian(12);                   // external
  AedatRecording recording(folder.Write("a.aedat", file));
  const EventArray e = AllEvents(&recording, 128, 128);
  EXPECT_EQ(e.t, (std::vector<Utime>{10, 11}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{127, 0}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{0, 127}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0}));
}

}  // namespace
}  // namespace evit::formats
