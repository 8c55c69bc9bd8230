#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "procman_lcm/messages.hpp"

namespace evit::procman {

/// procman's channels. They have no prefix: a deputy's messages carry its id.
constexpr char kPmInfo[] = "PM_INFO", kPmOrders[] = "PM_ORDERS", kPmOutput[] = "PM_OUTPUT",
               kPmDiscover[] = "PM_DISCOVER";

/// Like DecodeChecked of common/bus/codec.h, for procman's types: bytes are checked before the generated
/// decoder sees them. False, with the reason in `why` (may be null), where they are not exactly one such
/// message.
template <typename Message>
bool DecodeProcman(const std::uint8_t* data, std::size_t size, Message* message, std::string* why = nullptr);

template <typename Message>
std::vector<std::uint8_t> EncodeProcman(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace evit::procman
