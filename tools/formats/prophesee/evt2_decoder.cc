#include "tools/formats/prophesee/evt2_decoder.h"

#include <cstring>
#include <utility>

namespace evit::formats {
namespace {

enum Type : unsigned { kOff = 0x0, kOn = 0x1, kTimeHigh = 0x8 };

constexpr std::uint32_t kHighMask = 0xFFF'FFFF;

// A word's upper 32 bits have one layout in both encodings: type, low bits of the stamp, column, row.
std::uint32_t Word32(const std::uint8_t* data, std::size_t k) {
  std::uint32_t word;
  std::memcpy(&word, data + 4 * k, 4);
  return word;
}
std::uint32_t Upper(const std::uint8_t* data, std::size_t k, bool first) {
  return Word32(data, 2 * k + (first ? 0 : 1));
}
std::uint32_t Lower(const std::uint8_t* data, std::size_t k, bool first) {
  return Word32(data, 2 * k + (first ? 1 : 0));
}

struct Fields {
  explicit Fields(std::uint32_t word)
      : type(word >> 28),
        low((word >> 22) & 0x3F),
        x(static_cast<std::uint16_t>((word >> 11) & 0x7FF)),
        y(static_cast<std::uint16_t>(word & 0x7FF)) {}
  unsigned type, low;
  std::uint16_t x, y;
};

// `upper(k)`: the upper half of word k. False where the next TIME_HIGH is needed and has not come yet.
template <typename Upper>
bool HandleTimeHigh(const Upper& upper, std::size_t k, std::size_t n, bool last, TimeHigh<28>* clock) {
  const std::uint32_t high = upper(k) & kHighMask;
  if (clock->Ordinary(high)) {
    clock->Step(high);
    return true;
  }
  std::size_t next = k + 1;
  while (next < n && upper(next) >> 28 != kTimeHigh) ++next;
  if (next == n && !last && k > 0) return false;
  next < n ? clock->Jump(high, upper(next) & kHighMask) : clock->JumpAlone(high);
  return true;
}

}  // namespace

std::size_t Evt2Decoder::Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) {
  const std::size_t n = size / 4;
  const auto upper = [data](std::size_t k) { return Word32(data, k); };
  for (std::size_t k = 0; k < n; ++k) {
    const Fields word(Word32(data, k));
    if (word.type == kTimeHigh) {
      if (!HandleTimeHigh(upper, k, n, last, &high_)) return 4 * k;
    } else if (word.type == kOff || word.type == kOn) {
      if (high_.known()) {
        events->push_back(Utime{high_.value()} * (1 << 6) + word.low, word.x, word.y,
                          word.type == kOn ? 1 : 0);
      } else {
        ++unstamped_;
      }
    }
  }
  return 4 * n;
}

std::size_t Evt21Decoder::Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) {
  const std::size_t n = size / 8;
  const auto upper = [&](std::size_t k) { return Upper(data, k, upper_half_first_); };
  for (std::size_t k = 0; k < n; ++k) {
    const Fields word(upper(k));
    if (word.type == kTimeHigh) {
      if (!HandleTimeHigh(upper, k, n, last, &high_)) return 8 * k;
    } else if (word.type == kOff || word.type == kOn) {
      const Utime t = Utime{high_.value()} * (1 << 6) + word.low;
      for (std::uint32_t valid = Lower(data, k, upper_half_first_); valid != 0; valid &= valid - 1) {
        if (high_.known()) {
          events->push_back(t, static_cast<std::uint16_t>(word.x + __builtin_ctz(valid)), word.y,
                            word.type == kOn ? 1 : 0);
        } else {
          ++unstamped_;
        }
      }
    }
  }
  return 8 * n;
}

bool Evt21Decoder::UpperHalfFirst(const std::uint8_t* data, std::size_t size, bool otherwise) {
  // TIME_HIGH words say it: their lower half is not used, and is 0; or else their stamps follow one another.
  const auto evidence = [&](bool first) {
    std::int64_t n = 0, empty = 0, successors = 0, before = -2;
    for (std::size_t k = 0; k < size / 8; ++k) {
      const std::uint32_t word = Upper(data, k, first);
      if (word >> 28 != kTimeHigh) continue;
      const std::int64_t high = word & kHighMask;
      ++n;
      if (Lower(data, k, first) == 0) ++empty;
      if (high == before || high == before + 1) ++successors;
      before = high;
    }
    return std::pair(2 * empty > n ? empty : 0, successors);
  };
  const auto upper_first = evidence(true), whole = evidence(false);
  return upper_first == whole ? otherwise : upper_first > whole;
}

}  // namespace evit::formats
