#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/bus/bus.h"

namespace evit {

/// Calls `object->method(data, size)` for each message on exactly this channel. `object` must outlive the
/// subscription.
template <typename T>
void Subscribe(Bus* bus, const std::string& channel, T* object,
               void (T::*method)(const std::uint8_t* data, std::size_t size)) {
  bus->Subscribe(channel, [object, method](const std::string& /*channel*/, const std::uint8_t* data,
                                           std::size_t size) { (object->*method)(data, size); });
}

}  // namespace evit
