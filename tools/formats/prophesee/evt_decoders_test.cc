#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "tools/formats/prophesee/dat_decoder.h"
#include "tools/formats/prophesee/evt2_decoder.h"
#include "tools/formats/prophesee/evt3_decoder.h"

namespace evit::formats {
namespace {

template <typename Word>
std::vector<std::uint8_t> Bytes(const std::vector<Word>& words) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(words.data());
  return {data, data + sizeof(Word) * words.size()};
}

// All events of a stream, given in pieces of `piece` bytes.
EventArray DecodeAll(EventDecoder* decoder, const std::vector<std::uint8_t>& bytes, std::size_t piece) {
  EventArray events;
  std::size_t used = 0, end = 0;
  while (end < bytes.size()) {
    end = std::min(bytes.size(), end + piece);
    used += decoder->Decode(bytes.data() + used, end - used, end == bytes.size(), &events);
  }
  return events;
}

std::uint16_t High(unsigned value) { return static_cast<std::uint16_t>(0x8000 | (value & 0xFFF)); }
std::uint16_t Low(unsigned value) { return static_cast<std::uint16_t>(0x6000 | value); }

TEST(Evt3Decoder, SingleEventsAndVectorsAreDecoded) {
  const std::vector<std::uint16_t> words = {0x2805,  // an event before the first stamp
                                            High(3),
                                            Low(7),                   // 3 * 4096 + 7 us
                                            0x0000 | 100,             // row 100
                                            0x2800 | 17,              // column 17, brighter
                                            0x2000 | 18,              // column 18, darker
                                            0x3800 | 200,             // vectors from column 200, brighter
                                            0x4000 | 0b100000000001,  // 12 columns: the first and the last
                                            0x5000 | 0b10000001,      // 8 more
                                            0xA001,
                                            0xE000,  // a trigger, others
                                            0x2000 | 19};
  for (const std::size_t piece : {2U, 3U, 7U, 1000U}) {
    Evt3Decoder decoder;
    const EventArray e = DecodeAll(&decoder, Bytes(words), piece);
    EXPECT_EQ(decoder.unstamped(), 1);
    EXPECT_EQ(e.x, (std::vector<std::uint16_t>{17, 18, 200, 211, 212, 219, 19}));
    EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 1, 1, 1, 1, 0}));
    EXPECT_EQ(e.y, std::vector<std::uint16_t>(7, 100));
    EXPECT_EQ(e.t, std::vector<Utime>(7, 3 * 4096 + 7));
  }
}

// 40 s of a sensor that says its TIME_HIGH every 4096 us: it wraps twice.
TEST(Evt3Decoder, TimeGoesOnWhereTheCounterWraps) {
  std::vector<std::uint16_t> words;
  for (unsigned high = 0; high < 10'000; ++high) {
    words.insert(words.end(), {High(high), Low(5), 0x2001, High(high)});
  }
  Evt3Decoder decoder;
  const EventArray e = DecodeAll(&decoder, Bytes(words), 1000);
  ASSERT_EQ(e.size(), 10'000U);
  for (std::size_t k = 0; k < e.size(); ++k) ASSERT_EQ(e.t[k], static_cast<Utime>(k) * 4096 + 5);
}

TEST(Evt3Decoder, BitErrorsInTimeHighAreIgnored) {
  std::mt19937 rng(5);
  std::vector<std::uint16_t> words;
  for (unsigned high = 100; high < 9'000; ++high) {
    const bool turned = high % 7 == 0;
    words.insert(words.end(),
                 {High(turned ? high ^ (1U << (rng() % 12)) : high), High(high), Low(5), 0x2001});
  }
  Evt3Decoder decoder;
  const EventArray e = DecodeAll(&decoder, Bytes(words), 1001);
  ASSERT_EQ(e.size(), 8'900U);
  for (std::size_t k = 0; k < e.size(); ++k) ASSERT_EQ(e.t[k], static_cast<Utime>(k + 100) * 4096 + 5);
}

// Words lost in transmission, or an encoder that says the time only where there are events.
TEST(Evt3Decoder, HolesInTimeAreFollowed) {
  std::vector<std::uint16_t> words;
  std::vector<Utime> expected;
  for (unsigned high = 0; high < 12'000; high += 1 + high % 900) {
    words.insert(words.end(), {High(high), Low(1), 0x2001});
    expected.push_back(Utime{high} * 4096 + 1);
  }
  words.push_back(
      words[words.size() - 3]);  // sensors repeat it; the last one of a stream could not be judged otherwise
  Evt3Decoder decoder;
  EXPECT_EQ(DecodeAll(&decoder, Bytes(words), 64).t, expected);
}

std::uint32_t Evt2Word(unsigned type, unsigned low, unsigned x, unsigned y) {
  return type << 28 | low << 22 | x << 11 | y;
}

TEST(Evt2Decoder, EventsAreDecodedAndTimeWraps) {
  constexpr std::uint32_t kEnd = 0x0FFF'FFFF;
  const std::vector<std::uint32_t> words = {
      0x8000'0000U | (kEnd - 1),
      Evt2Word(1, 3, 5, 6),
      0x8000'0000U | kEnd,
      Evt2Word(0, 63, 2047, 1000),
      0x8000'0000U,
      Evt2Word(1, 0, 1, 2),
      0x8000'0000U ^ 0x0010'0000U,  // a bit error: the next one denies it
      0x8000'0001U,
      Evt2Word(1, 1, 1, 2)};
  for (const std::size_t piece : {4U, 5U, 1000U}) {
    Evt2Decoder decoder;
    const EventArray e = DecodeAll(&decoder, Bytes(words), piece);
    constexpr Utime kWrap = Utime{1} << 34;
    EXPECT_EQ(e.t, (std::vector<Utime>{kWrap - 125, kWrap - 1, kWrap, kWrap + 65}));
    EXPECT_EQ(e.x, (std::vector<std::uint16_t>{5, 2047, 1, 1}));
    EXPECT_EQ(e.y, (std::vector<std::uint16_t>{6, 1000, 2, 2}));
    EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0, 1, 1}));
  }
}

TEST(Evt21Decoder, BothWordOrdersAreRecognisedAndDecoded) {
  std::mt19937 rng(7);
  std::vector<std::uint32_t> upper_first, little;
  EventArray expected;
  for (unsigned high = 1000; high < 1200; ++high) {
    const unsigned x = 32 * (rng() % 20), y = rng() % 720, p = rng() % 2, low = rng() % 64;
    const std::uint32_t valid = static_cast<std::uint32_t>(rng());
    for (const auto& [upper, lower] :
         {std::pair(0x8000'0000U | high, std::uint32_t{0}), std::pair(Evt2Word(p, low, x, y), valid)}) {
      upper_first.insert(upper_first.end(), {upper, lower});
      little.insert(little.end(), {lower, upper});
    }
    for (unsigned bit = 0; bit < 32; ++bit) {
      if ((valid >> bit & 1) != 0)
        expected.push_back(Utime{high} * 64 + low, static_cast<std::uint16_t>(x + bit),
                           static_cast<std::uint16_t>(y), static_cast<std::uint8_t>(p));
    }
  }
  for (const auto& [words, first] : {std::pair(upper_first, true), std::pair(little, false)}) {
    const std::vector<std::uint8_t> bytes = Bytes(words);
    ASSERT_EQ(Evt21Decoder::UpperHalfFirst(bytes.data(), bytes.size()), first);
    Evt21Decoder decoder(first);
    const EventArray e = DecodeAll(&decoder, bytes, 24);
    EXPECT_EQ(e.t, expected.t);
    EXPECT_EQ(e.x, expected.x);
    EXPECT_EQ(e.y, expected.y);
    EXPECT_EQ(e.p, expected.p);
  }
}

// Few events: TIME_HIGH words are sparse, and in the wrong order some masks look like such words.
TEST(Evt21Decoder, TheWordOrderOfSparseEventsIsRecognised) {
  std::mt19937 rng(7);
  std::vector<std::uint32_t> upper_first, little;
  for (unsigned high = 1000; high < 9000; high += 5 + rng() % 7) {
    for (const auto& [upper, lower] :
         {std::pair(0x8000'0000U | high, std::uint32_t{0}),
          std::pair(Evt2Word(rng() % 2, 3, 32 * (rng() % 10), rng() % 260), 1U << rng() % 32)}) {
      upper_first.insert(upper_first.end(), {upper, lower});
      little.insert(little.end(), {lower, upper});
    }
  }
  for (const bool otherwise : {false, true}) {
    for (const auto& [words, first] : {std::pair(upper_first, true), std::pair(little, false)}) {
      const std::vector<std::uint8_t> bytes = Bytes(words);
      EXPECT_EQ(Evt21Decoder::UpperHalfFirst(bytes.data(), bytes.size(), otherwise), first);
    }
  }
}

TEST(DatDecoder, EventsAreDecodedAndTimeWraps) {
  const std::vector<std::uint32_t> words = {0xFFFF'FFF0U, 1U << 28 | 719U << 14 | 1279U, 5,
                                            0U << 28 | 3U << 14 | 2U};
  DatDecoder decoder;
  const EventArray e = DecodeAll(&decoder, Bytes(words), 5);
  EXPECT_EQ(e.t, (std::vector<Utime>{0xFFFF'FFF0LL, (Utime{1} << 32) + 5}));
  EXPECT_EQ(e.x, (std::vector<std::uint16_t>{1279, 2}));
  EXPECT_EQ(e.y, (std::vector<std::uint16_t>{719, 3}));
  EXPECT_EQ(e.p, (std::vector<std::uint8_t>{1, 0}));
}

}  // namespace
}  // namespace evit::formats
