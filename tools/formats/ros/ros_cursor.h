#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "common/time/utime.h"

namespace evit::formats {

/// Walks through a serialized message of ROS 1 (packed) or ROS 2 (CDR: each number at a multiple of its size,
/// four bytes in front that say how, and in which order of bytes). Knows where the message ends: all throw
/// std::runtime_error naming the field that does not fit.
class RosCursor {
 public:
  RosCursor(const std::uint8_t* data, std::size_t size, bool cdr);

  const std::uint8_t* Take(std::size_t n, const char* field);
  template <typename Number>
  Number Get(const char* field) {
    if (cdr_) Align(sizeof(Number), field);
    std::array<std::uint8_t, sizeof(Number)> bytes;
    std::memcpy(bytes.data(), Take(sizeof(Number), field), sizeof(Number));
    if (big_endian_) std::reverse(bytes.begin(), bytes.end());
    Number value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  void Doubles(int n, double* out, const char* field);
  void SkipDoubles(int n, const char* field);
  /// std_msgs/Header; its stamp, and `frame` where given.
  Utime Header(std::string* frame = nullptr);
  /// A stamp within a message; nanoseconds are rounded.
  Utime Time(const char* field);
  std::string Text(const char* field);
  std::size_t left() const { return size_ - at_; }

 private:
  void Align(std::size_t n, const char* field);

  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
  bool cdr_, big_endian_ = false;
};

}  // namespace evit::formats
