#pragma once

#include <memory>
#include <string>

#include "common/bus/bus.h"

namespace evit {

/// A bus whose messages come from an LCM log: each Poll hands out the next message that has a subscriber, at
/// once and in the order of the log, and returns 0 at its end. What is published goes to the log `sink`
/// (empty: nowhere), stamped with the log time of the message last handed out: same log in, same log out,
/// byte for byte. Throws std::runtime_error as LogReader and LogWriter do.
std::unique_ptr<Bus> OpenLogBus(const std::string& source, const std::string& sink = "");

}  // namespace evit
