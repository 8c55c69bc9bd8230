#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace evit {

/// FNV-1a, eight bytes at a time: tells whether something has changed, no more. Of the bytes as they lie in
/// memory.
class ContentHash {
 public:
  void Add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (; size >= 8; size -= 8, bytes += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, 8);
      AddWord(word);
    }
    std::uint64_t rest = size;
    for (std::size_t k = 0; k < size; ++k) rest = rest << 8 | bytes[k];
    AddWord(rest);
  }
  template <typename Value>
  void AddValue(Value value) {
    static_assert(std::is_arithmetic_v<Value>);
    Add(&value, sizeof value);
  }
  std::uint64_t value() const { return value_; }

 private:
  void AddWord(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3U;
    value_ ^= value_ >> 29;  // a product alone never brings high bits down
  }
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace evit
