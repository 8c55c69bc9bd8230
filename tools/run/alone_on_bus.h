#pragma once

#include <string>

#include "common/bus/bus.h"

namespace evit::run {

/// Throws std::runtime_error where a deputy named `id` answers on the bus within a third of a second: another
/// `evit run` or `evit up`, whose services would hear ours and be heard, and whose orders would reach both.
void RequireAlone(Bus* bus, const std::string& id);

}  // namespace evit::run
