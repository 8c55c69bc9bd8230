#include "common/bus/memory_bus.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace evit {
namespace {

Bus::Handler Append(std::vector<std::string>* to) {
  return [to](const std::string& channel, const std::uint8_t* data, std::size_t size) {
    to->push_back(channel + ":" + std::string(data, data + size));
  };
}

TEST(MemoryBus, DeliversToEverySubscriberInOrder) {
  const auto hub = MakeMemoryHub();
  const auto sender = OpenMemoryBus(hub);
  const auto one = OpenMemoryBus(hub);
  const auto two = OpenMemoryBus(hub);
  std::vector<std::string> heard_one, heard_two;
  one->Subscribe("A", Append(&heard_one));
  one->Subscribe("B", Append(&heard_one));
  two->Subscribe("A", Append(&heard_two));
  two->Subscribe("A.", Append(&heard_two));  // no regular expression: does not match "AB"
  sender->Publish("A", "1", 1);
  sender->Publish("AB", "x", 1);
  sender->Publish("B", "2", 1);
  sender->Publish("A", "3", 1);
  EXPECT_TRUE(heard_one.empty());  // nothing outside Poll
  EXPECT_EQ(one->Poll(0), 3);
  EXPECT_EQ(two->Poll(0), 2);
  EXPECT_EQ(heard_one, (std::vector<std::string>{"A:1", "B:2", "A:3"}));
  EXPECT_EQ(heard_two, (std::vector<std::string>{"A:1", "A:3"}));
  EXPECT_EQ(one->Poll(0), 0);
}

TEST(MemoryBus, WhatAHandlerPublishesComesWithTheNextPoll) {
  const auto bus = OpenMemoryBus(MakeMemoryHub());
  int calls = 0;
  bus->Subscribe("A", [&](const std::string&, const std::uint8_t* data, std::size_t size) {
    ++calls;
    bus->Publish("A", data, size);
  });
  bus->Publish("A", "1", 1);
  EXPECT_EQ(bus->Poll(0), 1);
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(bus->Poll(0), 1);
}

TEST(MemoryBus, AClosedBusHearsNothing) {
  const auto hub = MakeMemoryHub();
  const auto sender = OpenMemoryBus(hub);
  std::vector<std::string> heard;
  OpenMemoryBus(hub)->Subscribe("A", Append(&heard));  // gone at once
  sender->Publish("A", "1", 1);
  EXPECT_TRUE(heard.empty());
}

}  // namespace
}  // namespace evit
