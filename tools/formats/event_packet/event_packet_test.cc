#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "tools/formats/event_packet/clock_fit.h"
#include "tools/formats/event_packet/event_packet_decoder.h"

namespace evit::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

template <typename Word>
EventPacket Packet(const std::string& encoding, std::uint64_t time_base, const std::vector<Word>& words) {
  EventPacket packet;
  packet.encoding = encoding;
  packet.time_base = time_base;
  packet.data = reinterpret_cast<const std::uint8_t*>(words.data());
  packet.size = sizeof(Word) * words.size();
  return packet;
}

TEST(EventPacketDecoder, MonoCountsNanosecondsFromTheTimeBase) {
  const std::vector<std::uint64_t> words = {1ULL << 63 | 479ULL << 48 | 639ULL << 32 | 5'000,
                                            3ULL << 32 | 6'999};
  EventPacketDecoder decoder;
  EventArray e;
  decoder.Decode(Packet("mono", 1'000'000'000, words), &e);
  EXPECT_EQ(e.t, (std::vector<Utime>{1'000'005, 1'000'006}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{639, 3}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{479, 0}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0}));
}

TEST(EventPacketDecoder, LibcaersStampsWrapWithinAPacket) {
  const std::vector<std::uint32_t> words = {345U << 17 | 259U << 2 | 2U | 1U, 0x7FFF'FFFF,
                                            1U << 17 | 2U << 2 | 1U, 4};
  EventPacketDecoder decoder;
  EventArray e;
  decoder.Decode(Packet("libcaer", 2'000'000'000, words), &e);
  EXPECT_EQ(e.t, (std::vector<Utime>{2'000'000 + 0x7FFF'FFFFLL, 2'000'004 + 0x8000'0000LL}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{345, 1}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{259, 2}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0}));
}

TEST(EventPacketDecoder, CompressedLibcaerHasVectorsAlongColumns) {
  const auto word = [](unsigned code, unsigned rest) {
    return static_cast<std::uint16_t>(code << 12 | rest);
  };
  const std::vector<std::uint16_t> words = {
      word(0, 0xFFF), word(1, 7),    word(2, 100), word(3, 0x800 | 50), word(4, 60),
      word(6, 0x801), word(5, 0x81), word(0, 0),   word(1, 1),          word(3, 51)};
  EventPacketDecoder decoder;
  EventArray e;
  decoder.Decode(Packet("libcaer_cmp", 1'000, words), &e);
  constexpr Utime kFirst = 1 + (0xFFF << 12) + 7;
  EXPECT_EQ(e.t, (std::vector<Utime>{kFirst, kFirst, kFirst, kFirst, kFirst, 1 + (1 << 24) + 1}));
  EXPECT_EQ(e.x, std::vector<std::uint16_t>(6, 100));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{50, 60, 71, 72, 79, 51}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0}));
}

TEST(EventPacketDecoder, AnUnknownEncodingIsNamed) {
  EventPacketDecoder decoder;
  EventArray e;
  EXPECT_THAT([&] { decoder.Decode(Packet<std::uint8_t>("bgr8", 0, {1}), &e); },
              ThrowsMessage<std::runtime_error>(HasSubstr("\"bgr8\"")));
}

TEST(ClockFit, OffsetAndDriftAreFoundBehindLateArrivals) {
  std::mt19937 rng(2);
  constexpr Utime kOffset = 1'665'782'665'000'000;
  for (const double seconds : {2.0, 60.0}) {
    for (const double drift : {0.0, 40e-6, -40e-6}) {
      ClockFit fit;
      for (Utime t = 500'000; t < static_cast<Utime>(1e6 * seconds); t += 1000) {
        Utime late = static_cast<Utime>(rng() % 400);
        if (rng() % 50 == 0) late += 20'000;  // the host was busy
        fit.Add(t, t + kOffset + static_cast<Utime>(drift * static_cast<double>(t)) + late);
      }
      fit.Solve();
      for (const double at : {0.5, 0.5 * seconds, seconds}) {
        const auto t = static_cast<Utime>(1e6 * at);
        const Utime expected = t + kOffset + static_cast<Utime>(drift * static_cast<double>(t));
        EXPECT_NEAR(static_cast<double>(fit.ToHost(t) - expected), 0, 100) << seconds << " s, " << drift;
      }
    }
  }
}

}  // namespace
}  // namespace evit::formats
