#include "tools/formats/rpg/rpg_events.h"

namespace evit::formats {
namespace {

constexpr std::size_t kPiece = 100'000;  // events

}  // namespace

RpgEvents::RpgEvents(const std::string& path, int width, int height)
    : path_(path), lines_(path, "t x y p"), filter_(width, height) {}

bool RpgEvents::Read(EventArray* events) {
  events->clear();
  while (events->size() < kPiece && lines_.Next()) {
    Utime t = 0;
    const bool finite = lines_.Time(&t);
    const std::int64_t x = lines_.Integer(), y = lines_.Integer(), p = lines_.Integer();
    lines_.End();
    if (p != 0 && p != 1) lines_.Fail("the polarity is " + std::to_string(p) + "; expected 0 or 1: t x y p");
    if (!finite) {
      filter_.CountInvalid();
    } else if (filter_.Keep(t, x, y)) {
      events->push_back(t, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                        static_cast<std::uint8_t>(p));
    }
  }
  return events->size() > 0;
}

}  // namespace evit::formats
