// Runs every kept input of one fuzz target: seeds, and findings of earlier fuzzing.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

TEST(Corpus, KeptInputsDoNotCrash) {
  int n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(EVIT_CORPUS)) {
    SCOPED_TRACE(entry.path().string());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    LLVMFuzzerTestOneInput(data, bytes.size());
    // Cut short and with single bits turned it must be survived too.
    std::vector<std::uint8_t> damaged(data, data + bytes.size());
    for (std::size_t k = 0; k < 64 && !damaged.empty(); ++k) {
      const std::size_t at = k * 2'654'435'761U % damaged.size();
      damaged[at] ^= static_cast<std::uint8_t>(1U << (k % 8));
      LLVMFuzzerTestOneInput(damaged.data(), k % 2 == 0 ? damaged.size() : at);
    }
    ++n;
  }
  EXPECT_GT(n, 0);
}

}  // namespace
