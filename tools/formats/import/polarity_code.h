#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace evit::formats {

/// Which numbers a recording says polarities with: 0 and 1, or -1 and 1, also as an unsigned number of 8 to
/// 64 bits keeps -1. Others have no one meaning and are refused by name.
class PolarityCode {
 public:
  /// 1 brighter, 0 darker. Throws std::runtime_error saying which values occur.
  std::uint8_t Read(std::int64_t value) {
    if (value == 1) return 1;
    if (value == 0 && minus_ == 0) return zero_ = true, 0;
    const bool minus = value == -1 || value == 0xff || value == 0xffff || value == 0xffffffff;
    if (minus && !zero_) return minus_ = value, 0;
    throw std::runtime_error(
        (minus || value == 0
             ? "the polarities 0 and " + std::to_string(value == 0 ? minus_ : value) + " both occur"
             : "the polarity is " + std::to_string(value)) +
        "; expected 0 and 1, or -1 and 1: write it so, 1 for brighter");
  }

 private:
  bool zero_ = false;
  std::int64_t minus_ = 0;  // as the file keeps -1; 0: has not occurred
};

}  // namespace evit::formats
