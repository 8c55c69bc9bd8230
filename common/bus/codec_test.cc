#include "common/bus/codec.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <stdexcept>

#include "tests/helpers/paths.h"
#include "tests/helpers/sample_map_messages.h"

namespace evit {
namespace {

using Messages = AllMessages<::testing::Types>;
template <typename Message>
class CodecTest : public ::testing::Test {};
TYPED_TEST_SUITE(CodecTest, Messages);

template <typename Message>
std::vector<std::uint8_t> Encoded(const Message& message) {
  std::vector<std::uint8_t> bytes;
  EncodeTo(message, &bytes);
  return bytes;
}

/// A copy that ends where its memory ends, so that a sanitizer sees one byte too many being read.
template <typename Message>
bool DecodeExact(const std::vector<std::uint8_t>& bytes, std::string* why = nullptr) {
  const std::unique_ptr<std::uint8_t[]> copy(new std::uint8_t[bytes.size()]);
  std::copy(bytes.begin(), bytes.end(), copy.get());
  Message out;
  return DecodeChecked(copy.get(), bytes.size(), &out, why);
}

TYPED_TEST(CodecTest, ComesBackAsItWas) {
  for (const int n : {0, 1, 2, 5, 37}) {
    const std::vector<std::uint8_t> bytes = Encoded(Sample<TypeParam>(n));
    TypeParam out = Sample<TypeParam>(9);  // used before: nothing of it may remain
    std::string why;
    ASSERT_TRUE(DecodeChecked(bytes.data(), bytes.size(), &out, &why)) << n << ": " << why;
    EXPECT_EQ(Encoded(out), bytes) << n;  // throws where a vector of the old message is left
  }
}

TYPED_TEST(CodecTest, EveryTruncationIsRefused) {
  const std::vector<std::uint8_t> bytes = Encoded(Sample<TypeParam>());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    std::string why;
    EXPECT_FALSE(
        DecodeExact<TypeParam>({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}, &why));
    EXPECT_FALSE(why.empty());
  }
}

TYPED_TEST(CodecTest, AByteTooManyIsRefused) {
  std::vector<std::uint8_t> bytes = Encoded(Sample<TypeParam>());
  bytes.push_back(0);
  EXPECT_FALSE(DecodeExact<TypeParam>(bytes));
}

TYPED_TEST(CodecTest, AnotherFingerprintIsRefused) {
  const std::vector<std::uint8_t> bytes = Encoded(Sample<TypeParam>());
  for (std::size_t i = 0; i < 8; ++i) {
    std::vector<std::uint8_t> other = bytes;
    other[i] ^= 1U;
    std::string why;
    EXPECT_FALSE(DecodeExact<TypeParam>(other, &why));
    EXPECT_NE(why.find("fingerprint"), std::string::npos);
  }
}

/// Every aligned or unaligned place that could be a count gets the values that hurt decoders.
TYPED_TEST(CodecTest, ForgedCountsDoNoHarm) {
  const std::vector<std::uint8_t> bytes = Encoded(Sample<TypeParam>());
  for (const std::uint32_t forged :
       {0xFFFFFFFFU, 0x80000000U, 0x7FFFFFFFU, 0x7FFFFFF0U, 0x10000000U, 0x0000FFFFU, 6U, 4U, 0U}) {
    for (std::size_t i = 8; i + 4 <= bytes.size(); ++i) {
      std::vector<std::uint8_t> other = bytes;
      for (std::size_t b = 0; b < 4; ++b) other[i + b] = static_cast<std::uint8_t>(forged >> (24 - 8 * b));
      DecodeExact<TypeParam>(
          other);  // may be valid still (the field may be a number); must not crash or reserve
    }
  }
}

/// 10,000 mutations of each type, the same at each run: bytes changed, runs overwritten, pieces cut out or
/// doubled.
TYPED_TEST(CodecTest, MutationsDoNoHarm) {
  std::mt19937 random(20'240'801);  // raw numbers only: the same with every standard library
  const std::vector<std::uint8_t> original = Encoded(Sample<TypeParam>());
  int refused = 0;
  constexpr int kMutations = 10'000;
  for (int i = 0; i < kMutations; ++i) {
    std::vector<std::uint8_t> bytes = original;
    for (unsigned changes = 1 + random() % 4; changes > 0 && !bytes.empty(); --changes) {
      const std::size_t at = random() % bytes.size();
      const std::size_t length = std::min<std::size_t>(1 + random() % 8, bytes.size() - at);
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
      const auto end = begin + static_cast<std::ptrdiff_t>(length);
      switch (random() % 5) {
        case 0:
          bytes[at] ^= static_cast<std::uint8_t>(1U << random() % 8);
          break;
        case 1:
          std::fill(begin, end, random() % 2 == 0 ? 0xFF : 0x00);
          break;
        case 2:
          for (auto b = begin; b != end; ++b) *b = static_cast<std::uint8_t>(random());
          break;
        case 3:
          bytes.erase(begin, end);
          break;
        default: {
          const std::vector<std::uint8_t> piece(begin, end);
          bytes.insert(begin, piece.begin(), piece.end());
        }
      }
    }
    if (!DecodeExact<TypeParam>(bytes)) ++refused;
  }
  EXPECT_GT(refused, kMutations / 4);
}

TYPED_TEST(CodecTest, RandomBytesAreRefused) {
  std::mt19937 random(7);
  const std::vector<std::uint8_t> original = Encoded(Sample<TypeParam>());
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::uint8_t> bytes(random() % 400);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
    EXPECT_FALSE(DecodeExact<TypeParam>(bytes));
    std::copy_n(original.begin(), std::min<std::size_t>(8, bytes.size()), bytes.begin());
    DecodeExact<TypeParam>(bytes);
  }
}

TYPED_TEST(CodecTest, AValidSeedForFuzzingIsKept) {
  const std::string type = TypeParam::getTypeName();
  const std::string path = test::SourcePath("tests/fuzz/corpus/messages/" +
                                            type.substr(0, type.size() - std::string("_t").size()));
  if (std::getenv("EVIT_WRITE_SEEDS") != nullptr && !std::ifstream(path)) {
    const std::vector<std::uint8_t> seed = Encoded(Sample<TypeParam>());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
  }
  std::ifstream file(path, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                        std::istreambuf_iterator<char>()};
  std::string why;
  EXPECT_TRUE(DecodeExact<TypeParam>(bytes, &why))
      << path << ": " << why << "; EVIT_WRITE_SEEDS=1 writes what is missing";
}

TEST(Codec, EncodingAVectorThatBeliesItsCountThrows) {
  event_packet_t m = Sample<event_packet_t>(5);
  m.x.pop_back();
  std::vector<std::uint8_t> bytes;
  EXPECT_THROW(EncodeTo(m, &bytes), std::logic_error);
}

TEST(Codec, EncodingReusesMemory) {
  std::vector<std::uint8_t> bytes;
  EncodeTo(Sample<event_packet_t>(1000), &bytes);
  const std::uint8_t* memory = bytes.data();
  EncodeTo(Sample<event_packet_t>(500), &bytes);
  EXPECT_EQ(bytes.data(), memory);
  EXPECT_EQ(bytes.size(), 8U + 28U + 9U * 500U);
}

TEST(Codec, AFullPacketFitsOneDatagram) { EXPECT_LE(Encoded(Sample<event_packet_t>(7000)).size(), 63'100U); }

}  // namespace
}  // namespace evit
