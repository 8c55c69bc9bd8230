#include "tools/formats/ros2/packed_message.h"

#include <algorithm>
#include <array>

#include "tools/formats/compression/decompress.h"

namespace evit::formats {
namespace {

constexpr std::array<std::uint8_t, 4> kZstd = {0x28, 0xB5, 0x2F, 0xFD};

}  // namespace

void PackedMessages::Unpack(RosMessage* message) {
  if (message->size < kZstd.size() || !std::equal(kZstd.begin(), kZstd.end(), message->data)) return;
  DecompressZstd(message->data, message->size, kMaxMessage, &contents_);
  message->data = contents_.data();
  message->size = contents_.size();
}

}  // namespace evit::formats
