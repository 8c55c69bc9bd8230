#pragma once

#include <memory>
#include <string>

#include "common/bus/bus.h"
#include "common/bus/memory_bus.h"  // IWYU pragma: export

namespace evit {

/// The bus over LCM. Asks for the receive buffer in the URL (udpm: 4 MiB where the URL names none), reads
/// back what the kernel granted. Subscriptions have no queue limit of their own: what is bounded is bounded
/// by the services. Throws std::runtime_error with the remedy where the URL cannot be opened (e.g. no
/// multicast route).
std::unique_ptr<Bus> OpenLcmBus(const std::string& url);

}  // namespace evit
