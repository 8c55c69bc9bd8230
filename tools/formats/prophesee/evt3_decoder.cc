#include "tools/formats/prophesee/evt3_decoder.h"

#include <algorithm>
#include <cstring>

namespace evit::formats {
namespace {

enum Type : unsigned {
  kAddrY = 0x0,
  kAddrX = 0x2,
  kVectBaseX = 0x3,
  kVect12 = 0x4,
  kVect8 = 0x5,
  kTimeLow = 0x6,
  kTimeHigh = 0x8,
};

constexpr std::size_t kMaxPerWord = 12;  // events

std::uint16_t Word(const std::uint8_t* data, std::size_t k) {
  std::uint16_t word;
  std::memcpy(&word, data + 2 * k, 2);
  return word;
}

// Room for the most events that may come, written through plain pointers: push_back would take most of the
// time.
struct Output {
  explicit Output(EventArray* e, std::size_t room) : events(e), n(e->size()) { Resize(n + room); }
  ~Output() { Resize(n); }
  void Resize(std::size_t size) {
    events->t.resize(size), events->x.resize(size), events->y.resize(size), events->p.resize(size);
  }
  void Put(Utime t, unsigned x, std::uint16_t y, std::uint8_t p) {
    events->t[n] = t;
    events->x[n] = static_cast<std::uint16_t>(x);
    events->y[n] = y;
    events->p[n++] = p;
  }
  EventArray* events;
  std::size_t n;
};

}  // namespace

// False where the next TIME_HIGH is needed for judgement and has not come yet.
bool Evt3Decoder::HandleTimeHigh(const std::uint8_t* data, std::size_t k, std::size_t n, bool last) {
  const std::uint32_t high = Word(data, k) & 0xFFFU;
  bool changed = false;
  if (high_.Ordinary(high)) {
    changed = high_.Step(high);
  } else {
    std::size_t next = k + 1;
    while (next < n && Word(data, next) >> 12 != kTimeHigh) ++next;
    if (next == n && !last && k > 0) return false;
    changed = next < n ? high_.Jump(high, Word(data, next) & 0xFFFU) : high_.JumpAlone(high);
  }
  if (changed) low_ = 0;
  time_ = Utime{high_.value()} * (1 << 12) + low_;
  return true;
}

std::size_t Evt3Decoder::Decode(const std::uint8_t* data, std::size_t size, bool last, EventArray* events) {
  constexpr std::size_t kBlock = 4096;  // words for which room is made at a time
  const std::size_t n = size / 2;
  std::size_t k = 0;
  while (k < n) {
    const std::size_t end = std::min(n, k + kBlock);
    Output out(events, kMaxPerWord * (end - k));
    for (; k < end; ++k) {
      const std::uint16_t word = Word(data, k);
      switch (word >> 12) {
        case kTimeLow:
          low_ = word & 0xFFF;
          time_ = Utime{high_.value()} * (1 << 12) + low_;
          break;
        case kTimeHigh:
          if (!HandleTimeHigh(data, k, n, last)) return 2 * k;
          break;
        case kAddrY:
          y_ = word & 0x7FF;
          break;
        case kAddrX:
          if (high_.known()) {
            out.Put(time_, word & 0x7FF, y_, (word >> 11) & 1);
          } else {
            ++unstamped_;
          }
          break;
        case kVectBaseX:
          base_x_ = word & 0x7FF;
          polarity_ = (word >> 11) & 1;
          break;
        case kVect12:
        case kVect8: {
          const bool twelve = word >> 12 == kVect12;
          for (unsigned valid = word & (twelve ? 0xFFFU : 0xFFU); valid != 0; valid &= valid - 1) {
            if (high_.known()) {
              out.Put(time_, base_x_ + static_cast<unsigned>(__builtin_ctz(valid)), y_, polarity_);
            } else {
              ++unstamped_;
            }
          }
          base_x_ = static_cast<std::uint16_t>(base_x_ + (twelve ? 12 : 8));
          break;
        }
        default:  // triggers, vendor's words
          break;
      }
    }
  }
  return 2 * n;
}

}  // namespace evit::formats
