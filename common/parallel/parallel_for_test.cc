#include "common/parallel/parallel_for.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace evit {
namespace {

TEST(ParallelFor, CallsEachIndexOnce) {
  for (const int threads : {1, 3}) {
    std::vector<int> calls(100, 0);
    ParallelFor(100, threads, [&](int i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(100, 1));
  }
}

TEST(ParallelFor, ThrowsAgainWhatTheWorkThrew) {
  for (const int threads : {1, 3}) {
    EXPECT_THROW(ParallelFor(20, threads,
                             [](int i) {
                               if (i == 7) throw std::runtime_error("seven");
                             }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace evit
