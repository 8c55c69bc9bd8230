#include "tools/formats/hdf5/ecf_chunk.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/helpers/ecf_encoder.h"

namespace evit::formats {
namespace {

using Numbers = std::vector<std::int64_t>;

std::vector<H5Event> Decode(const std::string& chunk) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(chunk.data());
  std::vector<H5Event> out(EcfEvents(data, chunk.size()));
  if (!DecodeEcf(data, chunk.size(), out.data())) out.clear();
  return out;
}

// x, y, p, t of each event, one after the other.
Numbers Flat(const std::vector<H5Event>& events) {
  Numbers out;
  for (const H5Event& e : events) out.insert(out.end(), {e.x, e.y, e.p, e.t});
  return out;
}

std::string Chars(const std::vector<int>& bytes) { return {bytes.begin(), bytes.end()}; }

// By hand: 3 events; they begin at 256 us; two at once, then one 0x12 + 1 us later.
const std::vector<int> kStamps = {0, 1, 0, 0, 0, 0, 0, 0, 0x02, 0xF2, 0xF1, 0x11};

std::string Chunk(int flags, const std::vector<int>& rest) {
  std::vector<int> bytes = {3 << 2 | flags, 0, 0, 0};
  bytes.insert(bytes.end(), kStamps.begin(), kStamps.end());
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return Chars(bytes);
}

TEST(EcfChunk, ColumnsAsMasksByHand) {
  // Rows: 5 twice, 7 once. Columns: 100, and 102 and 105 after it (bits 3 and 0). Polarity: 1 once, 0 twice.
  const std::string chunk = Chunk(0, {0xA2, 0x00, 0xE1, 0x00, 0x89, 0x0C, 0x81, 0x02});
  EXPECT_EQ(Flat(Decode(chunk)), (Numbers{100, 5, 1, 256, 102, 5, 0, 256, 105, 7, 0, 275}));
}

TEST(EcfChunk, ColumnsPackedByHand) {
  // e = 0xABC, f = 0x123, g = 0xFED, h = 0: words 0xABC3, 0x12ED, 0xF000.
  const std::string chunk = Chunk(1, {0xA2, 0x00, 0xE1, 0x00, 0xC3, 0xAB, 0xED, 0x12, 0x00, 0xF0});
  EXPECT_EQ(Flat(Decode(chunk)),
            (Numbers{0xABC >> 1, 5, 0, 256, 0x123 >> 1, 5, 1, 256, 0xFED >> 1, 7, 1, 275}));
}

TEST(EcfChunk, AllPackedByHand) {
  // e = 0x2CF4FF (y 719, x 639, p 1), f = 0x001002 (y 1, x 1, p 0), g = 0x7FFABC (y 2047, x 0x55E, p 0), h =
  // 0.
  const std::string chunk =
      Chunk(2, {0x02, 0xFF, 0xF4, 0x2C, 0xBC, 0xFA, 0x10, 0x00, 0x00, 0x00, 0x00, 0x7F});
  EXPECT_EQ(Flat(Decode(chunk)), (Numbers{639, 719, 1, 256, 1, 1, 0, 256, 0x55E, 2047, 0, 275}));
}

TEST(EcfChunk, LongRunsByHand) {
  // 300 events of one stamp, row and polarity, in one column: every run has its number behind it.
  std::string chunk = Chars({300 * 4 % 256, 300 * 4 / 256, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0x0F, 44, 1,  //
                             0x3F, 0, 44, 1});
  for (int k = 0; k < 300; ++k) chunk += Chars({0x40, 0});
  chunk += Chars({0xFF, 44, 1});
  const std::vector<H5Event> events = Decode(chunk);
  ASSERT_EQ(events.size(), 300U);
  for (const H5Event& e : events) EXPECT_EQ(Flat({e}), (Numbers{2, 1, 1, 9}));
}

TEST(EcfChunk, WhatIsCutOffOrRunsTooFarIsRefused) {
  for (const auto& [flags, rest] : std::vector<std::pair<int, std::vector<int>>>{
           {0, {0xA2, 0x00, 0xE1, 0x00, 0x89, 0x0C, 0x81, 0x02}},
           {1, {0xA2, 0x00, 0xE1, 0x00, 0xC3, 0xAB, 0xED, 0x12, 0x00, 0xF0}},
           {2, {0x02, 0xFF, 0xF4, 0x2C, 0xBC, 0xFA, 0x10, 0x00, 0x00, 0x00, 0x00, 0x7F}}}) {
    const std::string chunk = Chunk(flags, rest);
    ASSERT_EQ(Decode(chunk).size(), 3U);
    for (std::size_t n = 0; n < chunk.size(); ++n) EXPECT_TRUE(Decode(chunk.substr(0, n)).empty()) << n;
  }
  EXPECT_TRUE(Decode(Chunk(0, {0xA4, 0x00, 0x89, 0x0C, 0x81, 0x02})).empty());              // four rows
  EXPECT_TRUE(Decode(Chunk(0, {0xA2, 0x00, 0xE1, 0x00, 0x89, 0x0C, 0x81, 0x03})).empty());  // polarities
  std::string steps = Chunk(0, {});
  steps.replace(13, std::string::npos, std::string(20, '\xF1'));  // a stamp of more than 64 bits
  EXPECT_TRUE(Decode(steps).empty());
  EXPECT_EQ(EcfEvents(reinterpret_cast<const std::uint8_t*>("\xFF\xFF\xFF\xFF        "), 12), 0U);
}

TEST(EcfChunk, WrittenAndReadIsEqual) {
  std::mt19937 rng(3);
  for (const auto way :
       {EcfEncoder::Way::kMasks, EcfEncoder::Way::kColumnsPacked, EcfEncoder::Way::kAllPacked}) {
    for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 16384U, 65535U}) {
      std::vector<H5Event> events(n);
      std::int64_t t = 1'600'000'000'000'000;
      unsigned x = 0, y = 0;
      for (H5Event& e : events) {
        if (rng() % 4 == 0) t += rng() % 8 == 0 ? rng() % 100'000 : rng() % 16;
        if (rng() % 8 == 0) y = rng() % 2048;
        x = rng() % 2 == 0 ? (x + 1) % 2048 : rng() % 2048;
        e = {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
             static_cast<std::int16_t>(rng() % 16 != 0), t};
      }
      EXPECT_EQ(Flat(Decode(EcfEncoder::Encode(events, way))), Flat(events)) << n;
    }
  }
}

}  // namespace
}  // namespace evit::formats
