#include "common/diagnosis/event_census.h"

#include <algorithm>
#include <limits>

namespace evit::diagnosis {
namespace {

constexpr Utime kNever = std::numeric_limits<Utime>::min() / 2;
constexpr std::int64_t kJudged = 4;  // one of so many events
constexpr int kNear = 2;             // pixels
constexpr Utime kMostBins = 3'600'000;

}  // namespace

EventCensus::EventCensus(int width, int height)
    : width_(width),
      height_(height),
      by_pixel_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0),
      fired_(by_pixel_.size(), kNever) {}

void EventCensus::JudgeCompany(Utime t, int x, int y) {
  Utime newest = kNever;
  for (int v = std::max(0, y - kNear); v <= std::min(height_ - 1, y + kNear); ++v) {
    for (int u = std::max(0, x - kNear); u <= std::min(width_ - 1, x + kNear); ++u) {
      if (u == x && v == y) continue;  // a pixel that fires by itself is not company
      newest = std::max(newest, fired_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                                       static_cast<std::size_t>(u)]);
    }
  }
  ++company_.judged;
  for (std::size_t k = 0; k < Company::kWithin.size(); ++k)
    company_.alone[k] += t - newest > Company::kWithin[k] ? 1 : 0;
}

void EventCensus::Add(const EventArray& events) {
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Utime t = events.t[k];
    const int x = events.x[k], y = events.y[k];
    if (count_ == 0) first_ = newest_ = t;
    if (t < newest_) ++backward_;
    newest_ = t;
    first_ = std::min(first_, t);
    last_ = count_ == 0 ? t : std::max(last_, t);
    ++count_;
    brighter_ += events.p[k] != 0 ? 1 : 0;
    max_x_ = std::max(max_x_, x);
    max_y_ = std::max(max_y_, y);
    if (const Utime bin = (t - first_) / kBin; bin >= 0 && bin < kMostBins) {
      if (static_cast<std::size_t>(bin) >= bins_.size()) bins_.resize(static_cast<std::size_t>(bin) + 1);
      Bin& b = bins_[static_cast<std::size_t>(bin)];
      ++(events.p[k] != 0 ? b.brighter : b.darker);
    }
    if (x >= width_ || y >= height_) {
      ++outside_;
      continue;
    }
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    if (count_ % kJudged == 0) JudgeCompany(t, x, y);
    ++by_pixel_[pixel];
    fired_[pixel] = t;
  }
}

}  // namespace evit::diagnosis
