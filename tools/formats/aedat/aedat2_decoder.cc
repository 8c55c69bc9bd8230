#include "tools/formats/aedat/aedat2_decoder.h"

#include <cstring>

#include "common/geometry/degrees.h"
#include "common/imu/standard_gravity.h"

namespace evit::formats {
namespace {

// Full scales that jAER sets in a DAVIS's IMU: 1000 degrees a second, 8 g.
constexpr double kGyroUnit = 1000.0 / 32768 * kRadiansPerDegree;
constexpr double kAccelUnit = 8.0 / 32768 * kStandardGravity;
constexpr int kTemperature = 3, kValues = 7;

std::uint32_t Load(const std::uint8_t* data) {
  std::uint32_t value;
  std::memcpy(&value, data, 4);
  return __builtin_bswap32(value);
}

}  // namespace

// A sample comes as seven values, one after the other: accelerations, temperature, angular rates.
void Aedat2Decoder::Imu(std::uint32_t address, Utime t, std::vector<ImuSample>* imu) {
  const int which = static_cast<int>((address >> 28) & 7);
  const auto value = static_cast<std::int16_t>((address >> 12) & 0xFFFF);
  if (which == 0) next_ = 0;
  if (which != next_ || which >= kValues) {  // part of it is lost
    next_ = kValues;
    return;
  }
  if (which < kTemperature) sample_.accel[which] = kAccelUnit * value;
  if (which > kTemperature) sample_.gyro[which - kTemperature - 1] = kGyroUnit * value;
  if (++next_ < kValues) return;
  sample_.t = t;
  imu->push_back(sample_);
}

std::size_t Aedat2Decoder::Decode(const std::uint8_t* data, std::size_t size, EventArray* events,
                                  std::vector<ImuSample>* imu) {
  const bool dvs128 = width_ == 128 && height_ == 128;
  const std::size_t n = size / 8;
  for (std::size_t k = 0; k < n; ++k) {
    const std::uint32_t address = Load(data + 8 * k), stamp = Load(data + 8 * k + 4);
    if (before_ > 0xF000'0000U && stamp < 0x1000'0000U) base_ += Utime{1} << 32;
    before_ = stamp;
    const Utime t = base_ + stamp;
    // jAER counts rows from the bottom and columns from the right; a DVS128's lowest bit is set where it got
    // darker. Pixels that are not on the sensor become large.
    if (dvs128) {
      if ((address & 0x8000) != 0) continue;  // external event
      events->push_back(t, static_cast<std::uint16_t>(127 - ((address >> 1) & 0x7F)),
                        static_cast<std::uint16_t>(127 - ((address >> 8) & 0x7F)), (address & 1) ^ 1);
    } else if (address >> 31 != 0) {
      if (((address >> 10) & 3) == 3) Imu(address, t, imu);  // else a frame's pixel
    } else if (((address >> 10) & 1) == 0) {
      events->push_back(t, static_cast<std::uint16_t>(width_ - 1 - static_cast<int>((address >> 12) & 0x3FF)),
                        static_cast<std::uint16_t>(height_ - 1 - static_cast<int>((address >> 22) & 0x1FF)),
                        (address >> 11) & 1);
    }
  }
  return 8 * n;
}

}  // namespace evit::formats
