#include "common/service/numbered_sender.h"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.h"
#include "tests/helpers/bus_messages.h"

namespace evit {
namespace {

TEST(NumberedSender, NumbersFromZeroAndKeepsTheNumberOfWhatIsSentAgain) {
  const std::shared_ptr<MemoryHub> hub = MakeMemoryHub();
  const std::unique_ptr<Bus> bus = OpenMemoryBus(hub), listener = OpenMemoryBus(hub);
  std::vector<stream_end_t> heard;
  test::Keep(listener.get(), "END", &heard);
  NumberedSender<stream_end_t> sender(bus.get(), "END", 7);
  stream_end_t message{};
  sender.Send(&message);
  sender.Send(&message);
  sender.SendAgain(message);
  listener->Poll(0);
  ASSERT_EQ(heard.size(), 3U);
  EXPECT_EQ(heard[0].seq, 0);
  EXPECT_EQ(heard[1].seq, 1);
  EXPECT_EQ(heard[2].seq, 1);
  for (const stream_end_t& m : heard) EXPECT_EQ(m.epoch, 7);
}

}  // namespace
}  // namespace evit
