#pragma once

#include <cstdint>
#include <vector>

#include "tools/formats/ros/message_store.h"

namespace evit::formats {

/// Decompresses the messages that `ros2 bag record --compression-mode message` packed one by one: Zstandard
/// frames, whose first bytes no message in CDR has.
class PackedMessages {
 public:
  /// Replaces the contents of a packed message, valid until the next call; leaves others. Throws
  /// std::runtime_error where they are damaged.
  void Unpack(RosMessage* message);

 private:
  std::vector<std::uint8_t> contents_;
};

}  // namespace evit::formats
