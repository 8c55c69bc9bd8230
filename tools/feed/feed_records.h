#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/events/event.h"
#include "common/imu/imu_sample.h"

/// Live data from any driver in any language: a stream of fixed little-endian records, one after the other.
///
///   event, 16 bytes: u8 1, u8 polarity (1 brighter, 0 darker), u16 column, u16 row, u16 0, i64 stamp (us)
///   IMU sample, 64 bytes: u8 2, 7 bytes 0, i64 stamp (us), 3 x f64 angular rate (rad/s),
///     3 x f64 specific force (m/s^2)
namespace evit::feed {

inline constexpr std::size_t kEventBytes = 16, kImuBytes = 64;

void AppendRecord(Utime t, std::uint16_t x, std::uint16_t y, std::uint8_t p, std::string* bytes);
void AppendRecord(const ImuSample& sample, std::string* bytes);

/// Takes records out of bytes that arrive in pieces.
class RecordParser {
 public:
  /// Appends what is whole; keeps the rest for the next call. Throws std::runtime_error where a record is of
  /// no known kind, with the byte it begins at: behind it nothing can be trusted.
  void Parse(const std::uint8_t* data, std::size_t size, EventArray* events, std::vector<ImuSample>* imu);
  /// Bytes of a record that is not whole yet.
  std::size_t pending() const { return rest_.size(); }

 private:
  std::size_t ParseWhole(const std::uint8_t* data, std::size_t size, EventArray* events,
                         std::vector<ImuSample>* imu);

  std::vector<std::uint8_t> rest_;
  std::uint64_t position_ = 0;  // of the next record in the stream
};

}  // namespace evit::feed
