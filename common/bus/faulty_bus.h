#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.h"

namespace evit {

/// What goes wrong with messages that arrive, for tests: a seeded choice for each message.
struct BusFaults {
  struct Rule {
    std::string channel;   // "*": every channel without a rule of its own
    double loss = 0;       // share of messages that never arrive
    double duplicate = 0;  // share that arrives twice
    double reorder = 0;    // share that arrives after the channel's next message
    int delay_ms = 0;      // how late each message arrives
  };
  std::vector<Rule> rules;
  std::uint64_t seed = 1;
};

/// Reads "EVENTS:loss=0.05,duplicate=0.01;KEYFRAME:reorder=0.1;*:delay=5;seed=3". Throws
/// std::invalid_argument naming the part that is wrong.
BusFaults ParseBusFaults(const std::string& text);

/// A bus whose messages suffer these faults on arrival. Sending is not touched, so each listener loses
/// others.
std::unique_ptr<Bus> MakeFaultyBus(std::unique_ptr<Bus> bus, const BusFaults& faults);

}  // namespace evit
