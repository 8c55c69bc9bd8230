#include "tools/formats/compression/decompress.h"

#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <random>

namespace evit::formats {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes Lz4(const Bytes& in) {
  Bytes out(LZ4F_compressFrameBound(in.size(), nullptr));
  out.resize(LZ4F_compressFrame(out.data(), out.size(), in.data(), in.size(), nullptr));
  return out;
}
Bytes Zstd(const Bytes& in) {
  Bytes out(ZSTD_compressBound(in.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), in.data(), in.size(), 1));
  return out;
}

TEST(Decompress, FramesOfAnyLengthComeBackAndDamagedOnesAreRefused) {
  std::mt19937 rng(1);
  const struct {
    Bytes (*compress)(const Bytes&);
    void (*decompress)(const std::uint8_t*, std::size_t, std::size_t, Bytes*);
  } codecs[] = {{Lz4, DecompressLz4}, {Zstd, DecompressZstd}};
  for (const auto& codec : codecs) {
    Bytes out;
    for (const std::size_t n : {0U, 1U, 1000U, 65'536U, 65'537U, 3'000'000U}) {
      Bytes in(n);
      for (std::uint8_t& byte : in) byte = static_cast<std::uint8_t>(rng() % 7);
      const Bytes packed = codec.compress(in);
      codec.decompress(packed.data(), packed.size(), 4 << 20, &out);
      EXPECT_EQ(out, in);
      if (n < 1000) continue;
      EXPECT_THROW(codec.decompress(packed.data(), packed.size() / 2, 4 << 20, &out), std::runtime_error)
          << n;
      EXPECT_THROW(codec.decompress(packed.data(), packed.size(), n - 1, &out), std::runtime_error) << n;
      EXPECT_THROW(codec.decompress(in.data(), in.size(), 4 << 20, &out), std::runtime_error) << n;
    }
  }
}

}  // namespace
}  // namespace evit::formats
