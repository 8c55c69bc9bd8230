#pragma once

#include <string>

#include "common/bus/bus.h"

namespace evit {

/// The bus over LCM. Asks for the receive buffer in the URL (udpm: 4 MiB where the URL names none), reads back what the
/// kernel granted. Subscriptions have no queue limit of their own: what is bounded is bounded by the services.
/// Throws std::runtime_error with the remedy where the URL cannot be opened (e.g. no multicast route).
std::unique_ptr<Bus> OpenLcmBus(const std::string& url);

/// A bus inside this process: every message is delivered to every subscriber of its channel at the next Poll of the
/// bus it was subscribed on, in the order of publishing. Deterministic. For tests, and for pipelines in one process.
class MemoryHub;
std::shared_ptr<MemoryHub> MakeMemoryHub();
std::unique_ptr<Bus> OpenMemoryBus(std::shared_ptr<MemoryHub> hub);

}  // namespace evit
