#include "tools/formats/aedat/aedat3_decoder.h"

#include <stdexcept>
#include <string>

#include "common/files/load_number.h"
#include "common/geometry/degrees.h"
#include "common/imu/standard_gravity.h"

namespace evit::formats {
namespace {

constexpr std::size_t kHeader = 28, kMaxPacket = 1 << 28;  // bytes
enum Type { kPolarity = 1, kImu6 = 3, kImu9 = 4 };

struct Header {
  explicit Header(const std::uint8_t* data)
      : type(LoadNumber<std::int16_t>(data)),
        size(LoadNumber<std::int32_t>(data + 4)),
        stamp_at(LoadNumber<std::int32_t>(data + 8)),
        overflow(LoadNumber<std::int32_t>(data + 12)),
        number(LoadNumber<std::int32_t>(data + 20)) {}
  int type, size, stamp_at, overflow, number;
};

void Check(const Header& h) {
  if (h.size > 0 && h.number >= 0 && h.stamp_at >= 0 && h.stamp_at <= h.size - 4 && h.overflow >= 0 &&
      static_cast<std::uint64_t>(h.size) * static_cast<std::uint64_t>(h.number) <= kMaxPacket) {
    return;
  }
  throw std::runtime_error("a packet's header is damaged (type " + std::to_string(h.type) + ", " +
                           std::to_string(h.number) + " events of " + std::to_string(h.size) +
                           " bytes); copy the file again");
}

Eigen::Vector3d Vector(const std::uint8_t* data) {
  return {LoadNumber<float>(data), LoadNumber<float>(data + 4), LoadNumber<float>(data + 8)};
}

}  // namespace

std::size_t Aedat3Decoder::Decode(const std::uint8_t* data, std::size_t size, EventArray* events,
                                  std::vector<ImuSample>* imu) {
  std::size_t used = 0;
  while (size - used >= kHeader) {
    const Header h(data + used);
    Check(h);
    const auto item_bytes = static_cast<std::size_t>(h.size);
    const std::size_t length = kHeader + item_bytes * static_cast<std::size_t>(h.number);
    if (size - used < length) break;
    const std::uint8_t* item = data + used + kHeader;
    Utime base = Utime{h.overflow} << 31;
    std::int32_t before = 0;
    const bool is_imu = (h.type == kImu6 && h.size >= 36) || (h.type == kImu9 && h.size >= 48);
    for (int k = 0; k < h.number; ++k, item += item_bytes) {
      const auto word = LoadNumber<std::uint32_t>(item);
      // The packet's count is that of its first event.
      const auto stamp = LoadNumber<std::int32_t>(item + h.stamp_at);
      if (before > 0x7000'0000 && stamp >= 0 && stamp < 0x1000'0000) base += Utime{1} << 31;
      before = stamp;
      const Utime t = base + stamp;
      if ((word & 1) == 0) continue;  // marked as not valid
      if (h.type == kPolarity) {
        events->push_back(t, word >> 17, (word >> 2) & 0x7FFF, (word >> 1) & 1);
      } else if (is_imu) {
        imu->push_back({t, kRadiansPerDegree * Vector(item + 20), kStandardGravity * Vector(item + 8)});
      }
    }
    used += length;
  }
  return used;
}

}  // namespace evit::formats
