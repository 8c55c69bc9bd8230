#include "common/bus/faulty_bus.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "common/bus/memory_bus.h"

namespace evit {
namespace {

class FaultyBusTest : public ::testing::Test {
 protected:
  // What arrives of 10,000 numbered messages on channel A, with these faults.
  std::vector<int> Arrivals(const std::string& faults) {
    auto hub = MakeMemoryHub();
    const auto sender = OpenMemoryBus(hub);
    const auto receiver = MakeFaultyBus(OpenMemoryBus(hub), ParseBusFaults(faults));
    std::vector<int> arrived;
    receiver->Subscribe("A", [&](const std::string&, const std::uint8_t* data, std::size_t size) {
      EXPECT_EQ(size, 2u);
      arrived.push_back(data[0] * 256 + data[1]);
    });
    for (int k = 0; k < 10'000; ++k) {
      const std::uint8_t bytes[] = {static_cast<std::uint8_t>(k / 256), static_cast<std::uint8_t>(k % 256)};
      sender->Publish("A", bytes, sizeof bytes);
      receiver->Poll(0);
    }
    return arrived;
  }
};

TEST_F(FaultyBusTest, WithoutARuleNothingHappens) {
  const auto arrived = Arrivals("B:loss=1");
  ASSERT_EQ(arrived.size(), 10'000u);
  for (int k = 0; k < 10'000; ++k) EXPECT_EQ(arrived[static_cast<std::size_t>(k)], k);
}

TEST_F(FaultyBusTest, LosesTheStatedShareTheSameForTheSameSeed) {
  const auto first = Arrivals("*:loss=0.05;seed=3");
  EXPECT_NEAR(static_cast<double>(first.size()), 9'500, 4 * std::sqrt(10'000 * 0.05 * 0.95));
  EXPECT_EQ(first, Arrivals("*:loss=0.05;seed=3"));
  EXPECT_NE(first, Arrivals("*:loss=0.05;seed=4"));
}

TEST_F(FaultyBusTest, DuplicatesAndReorders) {
  const auto arrived = Arrivals("A:duplicate=0.1,reorder=0.1;*:loss=1");
  int again = 0, back = 0;
  for (std::size_t k = 1; k < arrived.size(); ++k) {
    again += arrived[k] == arrived[k - 1] ? 1 : 0;
    back += arrived[k] < arrived[k - 1] ? 1 : 0;
  }
  EXPECT_NEAR(again, 900, 150);
  EXPECT_NEAR(back, 900, 150);
}

TEST_F(FaultyBusTest, DelayedMessagesComeLater) {
  auto hub = MakeMemoryHub();
  const auto sender = OpenMemoryBus(hub);
  const auto receiver = MakeFaultyBus(OpenMemoryBus(hub), ParseBusFaults("A:delay=30"));
  int arrived = 0;
  receiver->Subscribe("A", [&](const std::string&, const std::uint8_t*, std::size_t) { ++arrived; });
  sender->Publish("A", "x", 1);
  const auto sent = std::chrono::steady_clock::now();
  receiver->Poll(0);
  EXPECT_EQ(arrived, 0);
  while (arrived == 0 && std::chrono::steady_clock::now() - sent < std::chrono::seconds(5)) receiver->Poll(1);
  EXPECT_EQ(arrived, 1);
  EXPECT_GE(std::chrono::steady_clock::now() - sent, std::chrono::milliseconds(30));
}

TEST_F(FaultyBusTest, NonsenseIsRefused) {
  for (const char* bad : {"EVENTS", "EVENTS:loss=2", "EVENTS:loss=-1", "EVENTS:lose=0.1", "EVENTS:loss=x",
                          ":loss=1", "EVENTS:delay=", "seed=x"}) {
    EXPECT_THROW(ParseBusFaults(bad), std::invalid_argument) << bad;
  }
  EXPECT_TRUE(ParseBusFaults("").rules.empty());
}

}  // namespace
}  // namespace evit
