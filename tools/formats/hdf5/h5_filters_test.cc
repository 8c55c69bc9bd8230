#include "tools/formats/hdf5/h5_filters.h"

#include <blosc.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <liblzf/lzf.h>
#include <lz4.h>

#include <numeric>

#include "tests/helpers/h5_files.h"
#include "tests/helpers/temporary_folder.h"
#include "tools/formats/hdf5/h5_file.h"

namespace evit::formats {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string BigEndian(std::uint64_t value, int bytes) {
  std::string out;
  for (int k = bytes - 1; k >= 0; --k) out += static_cast<char>(value >> (8 * k));
  return out;
}

std::string Lz4Frame(const char* data, std::size_t n, std::size_t block) {
  std::string out = BigEndian(n, 8) + BigEndian(block, 4);
  for (std::size_t at = 0; at < n; at += block) {
    const std::size_t plain = std::min(block, n - at);
    std::string packed(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(plain))), '\0');
    packed.resize(static_cast<std::size_t>(LZ4_compress_default(
        data + at, packed.data(), static_cast<int>(plain), static_cast<int>(packed.size()))));
    if (packed.size() >= plain) packed.assign(data + at, plain);
    out += BigEndian(packed.size(), 4) + packed;
  }
  return out;
}

TEST(H5Filters, CompressedDatasetsAreReadAndDamagedOnesRefused) {
  const TemporaryFolder folder("h5_filters");
  RegisterFilters();
  std::vector<std::int64_t> numbers(20'000);
  std::iota(numbers.begin(), numbers.end(), 1'000'000);
  const auto* data = reinterpret_cast<const char*>(numbers.data());
  const std::size_t n = 8 * numbers.size();
  std::string blosc(n + BLOSC_MAX_OVERHEAD, '\0'), lzf(n, '\0');
  blosc.resize(static_cast<std::size_t>(
      blosc_compress_ctx(5, 1, 8, n, data, blosc.data(), blosc.size(), "lz4", 0, 1)));
  lzf.resize(lzf_compress(data, static_cast<unsigned>(n), lzf.data(), static_cast<unsigned>(n) - 1));
  ASSERT_GT(lzf.size(), 0U);
  const struct {
    int filter;
    std::string chunk;
    std::vector<unsigned> values;
  } cases[] = {{32001, blosc, {2, 2, 8, static_cast<unsigned>(n)}},
               {32000, lzf, {4, 0x106, static_cast<unsigned>(n)}},
               {32004, Lz4Frame(data, n, 70'000), {0}},
               {32004, Lz4Frame(data, n, 1 << 20), {0}}};
  for (const auto& c : cases) {
    for (const bool damaged : {false, true}) {
      SCOPED_TRACE(c.filter);
      const std::string path = folder.File("a.h5");
      {
        H5Maker file(path);
        const std::string chunk = damaged ? c.chunk.substr(0, c.chunk.size() / 2) : c.chunk;
        file.Put("t", H5T_STD_I64LE, H5T_NATIVE_INT64, nullptr, {numbers.size()}, c.filter, chunk, c.values);
      }
      const H5File file(path);
      if (damaged) {
        EXPECT_THAT([&] { file.Open("t").ReadAll<std::int64_t>(); },
                    ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("dataset t"), HasSubstr("damaged"))));
      } else {
        EXPECT_EQ(file.Open("t").ReadAll<std::int64_t>(), numbers);
      }
    }
  }
}

TEST(H5Filters, AChunkThatIsWholeButTooShortIsRefused) {
  const TemporaryFolder folder("h5_filters");
  RegisterFilters();
  const std::vector<std::int64_t> few(100, 7);
  const std::string path = folder.File("a.h5");
  {
    H5Maker file(path);
    file.Put("t", H5T_STD_I64LE, H5T_NATIVE_INT64, nullptr, {20'000}, 32004,
             Lz4Frame(reinterpret_cast<const char*>(few.data()), 800, 800), {0});
  }
  const H5File file(path);
  EXPECT_THROW(file.Open("t").ReadAll<std::int64_t>(), std::runtime_error);
}

TEST(H5Filters, AMissingFilterIsNamedWithItsRemedy) {
  const TemporaryFolder folder("h5_filters");
  const std::string path = folder.File("a.h5");
  {
    H5Maker file(path);
    file.Put("t", H5T_STD_I64LE, H5T_NATIVE_INT64, nullptr, {4}, 32023, "12345678");
  }
  const H5File file(path);
  EXPECT_THAT([&] { file.Open("t").ReadAll<std::int64_t>(); },
              ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("a.h5"), HasSubstr("h5repack"))));
}

}  // namespace
}  // namespace evit::formats
