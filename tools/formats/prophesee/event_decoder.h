#pragma once

#include <cstddef>
#include <cstdint>

#include "common/events/event.h"

namespace evit::formats {

/// Decodes the words of one of Prophesee's event encodings. Keeps its state between calls: a stream may come
/// in pieces.
class EventDecoder {
 public:
  virtual ~EventDecoder() = default;
  /// Appends the events of `data` and returns how many of its bytes were used up; the rest is to be given
  /// again with what follows it. `last`: nothing follows now, use up every whole word.
  virtual std::size_t Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) = 0;
  /// Events that came before the stream's first stamp; they are left out.
  std::int64_t unstamped() const { return unstamped_; }

 protected:
  std::int64_t unstamped_ = 0;
};

}  // namespace evit::formats
