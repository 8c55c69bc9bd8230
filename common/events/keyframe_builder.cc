#include "common/events/keyframe_builder.h"

#include <algorithm>
#include <utility>

namespace evit {
namespace {

constexpr std::size_t kMaxEvents = 4'000'000;    // kept at most: 52 MB
constexpr std::size_t kMaxIntervalImu = 20'000;  // samples of one interval; a longer rest is a new beginning

}  // namespace

KeyframeBuilder::KeyframeBuilder(const Rig& rig, const Options& options, bool lossless)
    : width_(rig.camera.width),
      height_(rig.camera.height),
      without_imu_(options.without_imu),
      policy_(options.keyframes, options.surface, options.encoding == Keyframe::Encoding::kEventCount),
      merger_(width_, height_, lossless, rig.camera_time_offset, rig.imu_noise),
      clock_(options.imu_patience, /*from_first_event=*/lossless),
      image_(MakeKeyframeImage(options.encoding, width_, height_, options.surface)),
      feedback_(lossless) {}

void KeyframeBuilder::AddEvents(const EventArray& events, Utime watermark) {
  if (!merger_.AddEvents(events, watermark)) Restart();
  LimitMemory();
}

void KeyframeBuilder::AddImu(const ImuSample& sample) {
  if (!merger_.AddImu(sample)) Restart();
}

void KeyframeBuilder::Reset() {
  merger_.Clear();
  Restart();
}

void KeyframeBuilder::Restart() {
  next_seq_ -= static_cast<std::int64_t>(pending_.size());
  pending_.clear();
  image_->Clear();
  interval_.Clear();
  clock_.Clear();
  awaited_ = -1;
}

void KeyframeBuilder::LimitMemory() {
  if (merger_.kept() <= kMaxEvents || !pending_.empty()) return;
  const auto half = static_cast<std::int64_t>(merger_.kept() / 2);
  const std::int64_t begin = merger_.first(), end = begin + half;
  events_overrun_ += half;
  image_->Take(merger_.events(), merger_.IndexOf(begin), merger_.IndexOf(end));
  merger_.Release(end);
  last_position_ = std::max(last_position_, merger_.first());
}

std::optional<Keyframe> KeyframeBuilder::Next() {
  do {
    // Drawn as soon as it can be, so that feedback on it can come before the next is decided.
    if (!pending_.empty() &&
        merger_.Knows(pending_.front().keyframe.utime + pending_.front().keyframe.lookahead)) {
      Pending pending = std::move(pending_.front());
      pending_.pop_front();
      return Draw(std::move(pending));
    }
  } while (Decide());
  return std::nullopt;
}

// The next IMU sample that all events up to it are known of; without an IMU a tick instead, as a sample that
// says nothing but its time.
std::optional<ImuSample> KeyframeBuilder::NextSample() {
  if (without_imu_) {
    const std::optional<EventClock::Tick> tick = clock_.Next(merger_);
    if (clock_.running()) {
      while (merger_.NextImu() != nullptr) merger_.PopImu();
      if (!tick) return std::nullopt;
      if (tick->begins) interval_.Clear();
      ImuSample sample;
      sample.t = tick->t;
      return sample;
    }
  }
  const ImuSample* next = merger_.NextImu();
  if (next == nullptr) return std::nullopt;
  return *next;
}

void KeyframeBuilder::PopSample() {
  if (clock_.running()) {
    clock_.Pop();
  } else {
    merger_.PopImu();
  }
}

bool KeyframeBuilder::Decide() {
  awaited_ = -1;
  while (const std::optional<ImuSample> next = NextSample()) {
    const ImuSample& sample = *next;
    if (!interval_.begun()) {
      if (merger_.has_events() && sample.t >= merger_.first_event()) Begin(sample);
      PopSample();
      continue;
    }
    const TrackerFeedback* const feedback = feedback_.For(next_seq_);
    if (feedback == nullptr) {
      awaited_ = next_seq_ - FeedbackSchedule::kDelay;
      return false;
    }
    const auto due =
        policy_.Due({feedback->mode, feedback->keyframe_stride, feedback->useful_interval, interval_.begin(),
                     sample.t, interval_.newest().t, merger_.PositionAfter(sample.t) - last_position_,
                     static_cast<int>(interval_.size())});
    if (due) {
      Push(*due, sample, *feedback);
      if (*due == sample.t) PopSample();
      return true;
    }
    Take(sample);
    PopSample();
  }
  return false;
}

void KeyframeBuilder::Begin(const ImuSample& sample) {
  interval_.Begin(sample);
  first_ = true;
  last_position_ = merger_.PositionAfter(sample.t);
}

void KeyframeBuilder::Take(const ImuSample& sample) {
  if (interval_.size() >= kMaxIntervalImu) {
    Begin(sample);
  } else {
    interval_.Add(sample);
  }
}

void KeyframeBuilder::Push(Utime stamp, const ImuSample& sample, const TrackerFeedback& feedback) {
  Pending pending;
  Keyframe& k = pending.keyframe;
  k.utime = stamp;
  k.seq = next_seq_++;
  k.previous_utime = first_ ? stamp : interval_.begin();
  k.high_rate = policy_.IsHighRate(feedback.mode);
  pending.position = merger_.PositionAfter(stamp);
  k.n_events = pending.position - last_position_;
  const auto since = static_cast<double>(stamp - interval_.begin());
  k.decay_us = policy_.DecayUs(feedback.image_speed, since > 0 ? static_cast<double>(k.n_events) / since : 0);
  k.width = width_;
  k.height = height_;
  k.encoding = image_->encoding();
  const KeyframeImage::Span span = image_->SpanOf(k.previous_utime, stamp, k.decay_us);
  k.from_utime = span.from;
  k.lookahead = span.lookahead;
  ImuInterval::Closed interval = interval_.CloseAt(stamp, sample);
  if (!first_ && !clock_.running()) {
    k.imu = std::move(interval.samples);
    k.imu_gap = interval.gap;
  }
  first_ = false;
  last_position_ = pending.position;
  pending_.push_back(std::move(pending));
  // Should the clock jump, the keyframes still pending are decided again, from the feedback they had.
  feedback_.ForgetBefore(next_seq());
}

Keyframe KeyframeBuilder::Draw(Pending pending) {
  Keyframe& k = pending.keyframe;
  image_->Draw({merger_.events(), merger_.IndexOf(merger_.first()), merger_.IndexOf(pending.position),
                merger_.IndexOf(merger_.PositionAfter(k.utime + k.lookahead))},
               &k);
  merger_.Release(pending.position);
  return std::move(k);
}

}  // namespace evit
