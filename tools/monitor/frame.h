#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

namespace evit::monitor {

/// One message to viewers, as it goes over the wire. Made once and shared by all queues that hold it.
class Frame {
 public:
  explicit Frame(bool is_text) : is_text_(is_text), bytes_(kHead) {}

  bool is_text() const { return is_text_; }
  std::size_t size() const { return bytes_.size() - kHead; }
  const std::uint8_t* data() const { return bytes_.data() + kHead; }
  std::string_view text() const { return {reinterpret_cast<const char*>(data()), size()}; }

  /// Appends the bytes of numbers: little-endian on every machine that EVIT is built for.
  template <typename T>
  void Append(const T* values, std::size_t n) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + n * sizeof(T));
    if (n > 0) std::memcpy(bytes_.data() + at, values, n * sizeof(T));
  }
  template <typename T>
  void Append(T value) {
    Append(&value, 1);
  }
  void Reserve(std::size_t size) { bytes_.reserve(kHead + size); }

  /// Room in front of the data, where the WebSocket library writes its header.
  static constexpr std::size_t kHead = 64;

 private:
  bool is_text_;
  std::vector<std::uint8_t> bytes_;
};

using FramePtr = std::shared_ptr<const Frame>;

inline FramePtr TextFrame(std::string_view text) {
  auto frame = std::make_shared<Frame>(true);
  frame->Append(text.data(), text.size());
  return frame;
}

}  // namespace evit::monitor
