#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "common/time/utime.h"

namespace evit {

struct TimeOrderOptions {
  Utime window = 50'000;                // us: disorder of up to this is sorted
  Utime hole = 600 * kMicrosPerSecond;  // us: no recording is silent for as long
  std::size_t lookahead = 64;           // items that tell whether a stamp is an outlier
  bool strict = false;                  // equal stamps: only the first is kept (poses, IMU samples)
};

struct TimeOrderCounts {
  std::int64_t outlier = 0;  // dropped: far ahead of most that follow
  std::int64_t late = 0;     // dropped: behind others by more than the window, or, if strict, repeated
  std::int64_t sorted = 0;   // kept, moved to their place
};

/// Brings items (anything with a stamp `t`, us) into order of time. Sensors, drivers and simulators now and
/// then write one stamp that lies far ahead: were it believed, all behind it would be late. So an item that
/// is more than `window` ahead of everything before it is kept only if most of the next `lookahead` items are
/// not earlier: a true gap has them on its far side, an outlier does not. Equal stamps keep the order they
/// came in.
template <typename Item>
class TimeOrder {
 public:
  explicit TimeOrder(const TimeOrderOptions& options = {}) : options_(options) {}

  /// The next item as it comes.
  void Push(const Item& item) {
    ahead_.push_back(item);
    if (ahead_.size() > options_.lookahead) Decide(false);
  }
  /// No more will come.
  void Finish() {
    while (!ahead_.empty()) Decide(true);
    Release(std::numeric_limits<Utime>::max());
  }
  /// What is in its final place by now; empty where nothing is.
  std::vector<Item> Take() { return std::exchange(out_, {}); }

  const TimeOrderCounts& counts() const { return counts_; }

 private:
  void Decide(bool at_end) {
    const Item item = ahead_.front();
    ahead_.pop_front();
    if (IsOutlier(item.t, at_end)) {
      ++counts_.outlier;
    } else {
      Accept(item);
    }
  }

  bool IsOutlier(Utime t, bool at_end) const {
    if (begun_ && t <= newest_ + options_.window) return false;
    if (at_end && begun_ && ahead_.size() < kFew && t > newest_ + options_.hole) return true;
    const auto most = [&](auto earlier) {
      return 2 * std::count_if(ahead_.begin(), ahead_.end(),
                               [&](const Item& next) { return earlier(next.t); }) >
             static_cast<std::ptrdiff_t>(ahead_.size());
    };
    // What is too late itself says nothing of t.
    const Utime oldest = begun_ ? newest_ - options_.window : std::numeric_limits<Utime>::min();
    if (most([&](Utime next) { return next >= oldest && next < t - options_.window; })) return true;
    return !begun_ && most([&](Utime next) { return next > t + options_.hole; });
  }

  void Accept(const Item& item) {
    if (begun_ && (item.t < released_ || (options_.strict && item.t == released_))) {
      ++counts_.late;
      return;
    }
    if (begun_ && item.t < newest_) {
      if (item.t < newest_ - options_.window) {
        ++counts_.late;
        return;
      }
      disordered_ = true;
      ++counts_.sorted;
    }
    if (!begun_ || kept_.empty()) oldest_ = item.t;
    oldest_ = std::min(oldest_, item.t);
    newest_ = begun_ ? std::max(newest_, item.t) : item.t;
    begun_ = true;
    kept_.push_back(item);
    if (newest_ - oldest_ >= 2 * options_.window) Release(newest_ - options_.window);
  }

  // What can have nothing before it any more.
  void Release(Utime limit) {
    const auto earlier = [](const Item& a, const Item& b) { return a.t < b.t; };
    if (disordered_) std::stable_sort(kept_.begin(), kept_.end(), earlier);
    disordered_ = false;
    std::size_t n = 0;
    for (; n < kept_.size() && kept_[n].t <= limit; ++n) {
      if (options_.strict && kept_[n].t == released_) {
        ++counts_.late;
        continue;
      }
      released_ = kept_[n].t;
      out_.push_back(kept_[n]);
    }
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(n));
    if (!kept_.empty()) oldest_ = kept_.front().t;
  }

  static constexpr std::size_t kFew = 8;  // stray items at the end, if beyond a hole

  TimeOrderOptions options_;
  TimeOrderCounts counts_;
  std::deque<Item> ahead_;
  std::vector<Item> kept_, out_;
  bool begun_ = false, disordered_ = false;
  Utime newest_ = 0, oldest_ = 0, released_ = std::numeric_limits<Utime>::min();
};

/// The same for a list that is there whole.
template <typename Item>
std::vector<Item> InTimeOrder(const std::vector<Item>& items, const TimeOrderOptions& options,
                              TimeOrderCounts* counts) {
  TimeOrder<Item> order(options);
  for (const Item& item : items) order.Push(item);
  order.Finish();
  *counts = order.counts();
  return order.Take();
}

}  // namespace evit
