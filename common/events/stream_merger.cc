#include "common/events/stream_merger.h"

#include <algorithm>

#include "common/events/event_order.h"
#include "common/simd/lanes.h"

namespace evit {
namespace {

constexpr std::size_t kCompactAt = 1 << 16;  // events: dropping them from the front costs a move of the rest

EVIT_MULTIVERSION std::uint16_t Largest(const std::uint16_t* values, std::size_t n) {
  std::uint16_t largest = 0;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, values[i]);
  return largest;
}

EVIT_MULTIVERSION void AddOffset(Utime offset, Utime* t, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) t[i] += offset;
}

void EraseFront(EventArray* events, std::size_t n) {
  const auto count = static_cast<std::ptrdiff_t>(n);
  events->t.erase(events->t.begin(), events->t.begin() + count);
  events->x.erase(events->x.begin(), events->x.begin() + count);
  events->y.erase(events->y.begin(), events->y.begin() + count);
  events->p.erase(events->p.begin(), events->p.begin() + count);
}

}  // namespace

StreamMerger::StreamMerger(int width, int height, bool wait_for_events, Utime time_offset,
                           const ImuNoise& noise)
    : width_(width),
      height_(height),
      wait_for_events_(wait_for_events),
      offset_(time_offset),
      noise_(noise) {}

void StreamMerger::Clear() {
  dropped_ += static_cast<std::int64_t>(events_.size());
  events_.clear();
  imu_.clear();
  head_ = 0;
  has_events_ = has_imu_ = false;
  watermark_ = std::numeric_limits<Utime>::min();
}

bool StreamMerger::AddEvents(const EventArray& events, Utime watermark) {
  bool continued = true;
  const Utime first = (events.size() > 0 ? events.t.front() : watermark) + offset_;
  if (has_events_ && watermark_ != kEnd && first < watermark_ - kMaxDisorder) {
    Clear();
    ++counters_.resets;
    continued = false;
  }
  if (!has_events_) {
    has_events_ = true;
    first_event_ = watermark_ = first;
  }
  if (IsPlain(events)) {
    Append(events);
    newest_event_ = events_.t.back();
    watermark_ = std::max(watermark_, events.t.back() + offset_);
  } else {
    Filter(events);
  }
  watermark_ = std::max(watermark_, watermark + offset_);
  return continued;
}

// Nothing in it to be left out, as good as always.
bool StreamMerger::IsPlain(const EventArray& events) const {
  if (events.size() == 0 || events.t.front() + offset_ < Watermark()) return false;
  const std::size_t n = events.size();
  return NeverDecreases(events.t.data(), n) && Largest(events.x.data(), n) < width_ &&
         Largest(events.y.data(), n) < height_;
}

void StreamMerger::Append(const EventArray& events) {
  const std::size_t begin = events_.size();
  events_.t.insert(events_.t.end(), events.t.begin(), events.t.end());
  if (offset_ != 0) AddOffset(offset_, events_.t.data() + begin, events.size());
  events_.x.insert(events_.x.end(), events.x.begin(), events.x.end());
  events_.y.insert(events_.y.end(), events.y.begin(), events.y.end());
  events_.p.insert(events_.p.end(), events.p.begin(), events.p.end());
}

void StreamMerger::Filter(const EventArray& events) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Utime t = events.t[i] + offset_;
    // With real time's lead, decisions up to Watermark() are made: what comes now is late for them.
    if (t < Watermark()) {
      ++counters_.events_late;
      continue;
    }
    watermark_ = t;
    if (events.x[i] >= width_ || events.y[i] >= height_) {
      ++counters_.events_outside;
      continue;
    }
    events_.push_back(t, events.x[i], events.y[i], events.p[i]);
    newest_event_ = t;
  }
}

bool StreamMerger::AddImu(const ImuSample& sample) {
  constexpr double kBeyond = 1.1;  // of full scale: sensors deliver a little more than they promise
  const bool readable = sample.gyro.allFinite() && sample.accel.allFinite() &&
                        sample.gyro.cwiseAbs().maxCoeff() <= kBeyond * noise_.gyro_range &&
                        sample.accel.cwiseAbs().maxCoeff() <= kBeyond * noise_.accel_range;
  if (!readable) {
    ++counters_.imu_invalid;
    return true;
  }
  bool continued = true;
  if (has_imu_ && sample.t < last_imu_ - kMaxDisorder) {
    Clear();
    ++counters_.resets;
    continued = false;
  }
  if (has_imu_ && sample.t <= last_imu_) {
    ++counters_.imu_late;
    return continued;
  }
  if (imu_.size() >= kMaxImu) imu_.pop_front();
  imu_.push_back(sample);
  last_imu_ = sample.t;
  has_imu_ = true;
  return continued;
}

Utime StreamMerger::Watermark() const {
  if (wait_for_events_ || !has_imu_) return watermark_;
  return std::max(watermark_, last_imu_ - kImuLead);
}

const ImuSample* StreamMerger::NextImu() const {
  return !imu_.empty() && Knows(imu_.front().t) ? &imu_.front() : nullptr;
}

std::int64_t StreamMerger::PositionAfter(Utime t) const {
  const auto begin = events_.t.begin() + static_cast<std::ptrdiff_t>(head_);
  return first() + (std::upper_bound(begin, events_.t.end(), t) - begin);
}

void StreamMerger::Release(std::int64_t position) {
  head_ = IndexOf(position);
  if (head_ < kCompactAt || head_ * 2 < events_.size()) return;
  EraseFront(&events_, head_);
  dropped_ += static_cast<std::int64_t>(head_);
  head_ = 0;
}

}  // namespace evit
