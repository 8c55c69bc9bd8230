#include "tools/formats/rpg/rpg_events.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace evit::formats {
namespace {

constexpr std::size_t kPiece = 100'000;  // events

// Words for polarities, as programs write them beside numbers.
bool IsWord(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(),
                    [](char a, char b) { return (a | 0x20) == b; });
}

}  // namespace

RpgEvents::RpgEvents(const std::string& path, int width, int height)
    : path_(path), lines_(path, "t x y p"), filter_(width, height), columns_(FindEventColumns(path)) {
  if (columns_.size) lines_.Next();
  if (columns_.size && *columns_.size != std::pair(width, height)) {
    lines_.Fail("the first line says that the sensor has " + std::to_string(columns_.size->first) + "x" +
                std::to_string(columns_.size->second) + " pixels, expected " + std::to_string(width) + "x" +
                std::to_string(height) + "; give --size " + std::to_string(columns_.size->first) + "x" +
                std::to_string(columns_.size->second));
  }
}

std::uint8_t RpgEvents::ReadPolarity() {
  const std::string_view word = lines_.Word();
  for (const char* on : {"true", "t", "on", "pos", "positive"})
    if (IsWord(word, on)) return 1;
  for (const char* off : {"false", "f", "off", "neg", "negative"})
    if (IsWord(word, off)) return 0;
  if (word == "+" || word == "-") return word == "+" ? 1 : 0;
  double value = 0;
  if (!ParseNumber(word, &value) || !(std::abs(value) < 1e10) || value != std::floor(value))
    lines_.Fail("the polarity is " + std::string(word) + "; expected 0 or 1: t x y p");
  try {
    return filter_.Polarity(static_cast<std::int64_t>(value));
  } catch (const std::runtime_error& error) {
    lines_.Fail(error.what());
  }
}

DropCounts RpgEvents::dropped() const {
  DropCounts dropped = filter_.dropped();
  dropped.cut_off = cut_off_;
  return dropped;
}

bool RpgEvents::Read(EventArray* events) {
  events->clear();
  while (events->size() < kPiece && lines_.Next()) {
    cut_off_ = lines_.CutOff(columns_.n);
    if (cut_off_) break;
    Utime t = 0, fraction = 0;
    bool finite = true;
    std::int64_t x = 0, y = 0;
    std::uint8_t p = 0;
    for (std::size_t k = 0; k < columns_.n; ++k) {
      switch (columns_.field[k]) {
        case EventColumns::kTime:
          finite = lines_.Time(&t, columns_.unit) && finite;
          break;
        case EventColumns::kNanoseconds:
          finite = lines_.Time(&fraction, TimeUnit::kNanoseconds) && finite;
          break;
        case EventColumns::kX:
          x = lines_.Integer();
          break;
        case EventColumns::kY:
          y = lines_.Integer();
          break;
        case EventColumns::kPolarity:
          p = ReadPolarity();
          break;
        case EventColumns::kIgnored:
          lines_.Word();
      }
    }
    lines_.End();
    if (!finite) {
      filter_.CountInvalid();
    } else if (filter_.Keep(x, y)) {
      events->push_back(t + fraction, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), p);
    }
  }
  return events->size() > 0;
}

}  // namespace evit::formats
