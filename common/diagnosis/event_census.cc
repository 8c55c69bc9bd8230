#include "common/diagnosis/event_census.h"

#include <algorithm>
#include <limits>

namespace evit::diagnosis {
namespace {

constexpr Utime kNever = std::numeric_limits<Utime>::min() / 2;
constexpr std::int64_t kJudged = 4;  // one of so many events
constexpr int kNear = 2;             // pixels
constexpr Utime kMostBins = 3'600'000, kMostTileBins = 60'000;

void CountIn(std::vector<EventCensus::Bin>* bins, Utime at, std::uint8_t polarity) {
  if (static_cast<std::size_t>(at) >= bins->size()) bins->resize(static_cast<std::size_t>(at) + 1);
  EventCensus::Bin& bin = (*bins)[static_cast<std::size_t>(at)];
  ++(polarity != 0 ? bin.brighter : bin.darker);
}

}  // namespace

EventCensus::EventCensus(int width, int height)
    : width_(width),
      height_(height),
      by_pixel_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0),
      fired_(by_pixel_.size(), kNever),
      polarity_(by_pixel_.size(), 0),
      tiles_(std::size_t{kTilesX} * kTilesY) {}

void EventCensus::JudgeCompany(Utime t, int x, int y, std::uint8_t polarity) {
  Utime newest = kNever;
  bool alike = false;
  for (int v = std::max(0, y - kNear); v <= std::min(height_ - 1, y + kNear); ++v) {
    for (int u = std::max(0, x - kNear); u <= std::min(width_ - 1, x + kNear); ++u) {
      if (u == x && v == y) continue;  // a pixel that fires by itself is not company
      const auto pixel =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
      if (fired_[pixel] <= newest) continue;
      newest = fired_[pixel];
      alike = polarity_[pixel] == polarity;
    }
  }
  ++company_.judged;
  for (std::size_t k = 0; k < Company::kWithin.size(); ++k)
    company_.alone[k] += t - newest > Company::kWithin[k] ? 1 : 0;
  if (t - newest <= Company::kWithin.front()) ++(alike ? company_.alike : company_.unlike);
}

void EventCensus::Add(const EventArray& events) {
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Utime t = events.t[k];
    const int x = events.x[k], y = events.y[k];
    const std::uint8_t polarity = events.p[k] != 0 ? 1 : 0;
    if (count_ == 0) first_ = newest_ = t;
    if (t < newest_) ++backward_;
    if (t != newest_ || count_ == 0) ++stamps_;
    newest_ = t;
    first_ = std::min(first_, t);
    last_ = count_ == 0 ? t : std::max(last_, t);
    ++count_;
    brighter_ += polarity;
    max_x_ = std::max(max_x_, x);
    max_y_ = std::max(max_y_, y);
    const Utime bin = (t - first_) / kBin;
    if (bin >= 0 && bin < kMostBins) CountIn(&bins_, bin, polarity);
    if (x >= width_ || y >= height_) {
      ++outside_;
      continue;
    }
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    const int tile = y * kTilesY / height_ * kTilesX + x * kTilesX / width_;
    if (bin >= 0 && bin < kMostTileBins) CountIn(&tiles_[static_cast<std::size_t>(tile)], bin, polarity);
    if (count_ % kJudged == 0) JudgeCompany(t, x, y, polarity);
    ++by_pixel_[pixel];
    fired_[pixel] = t;
    polarity_[pixel] = polarity;
  }
}

}  // namespace evit::diagnosis
