#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "common/bus/bus.h"

namespace evit::commands {

/// The bus of the pipeline that runs on this host, whose network this process joins, or the one that
/// --lcm-url (`lcm_url`) or LCM_DEFAULT_URL names. Call before any thread or socket is made. Throws
/// std::runtime_error where no pipeline runs here and no bus is named.
std::unique_ptr<Bus> OpenBusOfPipeline(const std::string& lcm_url);

/// The same for somebody who sends EVENTS and IMU. Services may also have been started one by one: where no
/// pipeline runs, it is this host's own bus. `pid`: the pipeline's process where several run here, else 0.
/// Throws std::runtime_error where a replay sends to that pipeline already.
std::unique_ptr<Bus> OpenBusToFeed(const std::string& lcm_url, pid_t pid);

}  // namespace evit::commands
