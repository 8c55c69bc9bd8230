#pragma once

#include <memory>

#include "common/bus/bus.h"

namespace evit {

/// A bus inside this process: every message is delivered to every subscriber of its channel at the next Poll
/// of the bus it was subscribed on, in the order of publishing. Deterministic; Poll never waits. For tests,
/// and for pipelines in one process and one thread.
class MemoryHub;
std::shared_ptr<MemoryHub> MakeMemoryHub();
std::unique_ptr<Bus> OpenMemoryBus(std::shared_ptr<MemoryHub> hub);

}  // namespace evit
