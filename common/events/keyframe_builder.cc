#include "common/events/keyframe_builder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace evit {
namespace {

constexpr std::size_t kMaxEvents = 4'000'000;    // kept at most: 52 MB
constexpr std::size_t kMaxIntervalImu = 20'000;  // samples of one interval; a longer rest is a new beginning

class Stopwatch {
 public:
  double Lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - begin_).count();
    begin_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

KeyframeBuilder::KeyframeBuilder(const Rig& rig, const Options& options, bool lossless)
    : rig_(rig),
      lossless_(lossless),
      photometric_(options.event_counts),
      lookahead_(options.surface.kind == SurfaceOptions::Kind::kSymmetric
                     ? std::llround(options.surface.lookahead_ms * 1e3)
                     : 0),
      truncation_(options.surface.truncation),
      policy_(options.keyframes, options.surface),
      merger_(rig.camera.width, rig.camera.height, lossless, rig.camera_time_offset, rig.imu_noise),
      surface_(rig.camera.width, rig.camera.height),
      hot_pixels_(rig.camera.width, rig.camera.height, options.surface.hot_pixel_rate_hz),
      renderer_(rig.camera.width, rig.camera.height, options.surface),
      counter_(rig.camera.width, rig.camera.height) {}

void KeyframeBuilder::AddEvents(const EventArray& events, Utime watermark) {
  if (!merger_.AddEvents(events, watermark)) Restart();
  LimitMemory();
}

void KeyframeBuilder::AddImu(const ImuSample& sample) {
  if (!merger_.AddImu(sample)) Restart();
}

void KeyframeBuilder::SetFeedbackFor(std::int64_t seq, const TrackerFeedback& feedback) {
  newest_ = feedback;
  if (lossless_ && seq >= next_seq_ - 2) feedback_[seq] = feedback;
}

void KeyframeBuilder::Reset() {
  merger_.Clear();
  Restart();
}

void KeyframeBuilder::Restart() {
  next_seq_ -= static_cast<std::int64_t>(pending_.size());
  pending_.clear();
  surface_.Clear();
  hot_pixels_.Clear();
  begun_ = false;
  awaited_ = -1;
}

void KeyframeBuilder::LimitMemory() {
  if (merger_.kept() <= kMaxEvents || !pending_.empty()) return;
  const auto half = static_cast<std::int64_t>(merger_.kept() / 2);
  events_overrun_ += half;
  Apply(merger_.first() + half);
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

const TrackerFeedback* KeyframeBuilder::FeedbackForNext() const {
  if (!lossless_) return &newest_;
  if (next_seq_ < 2) return &default_;
  const auto found = feedback_.find(next_seq_ - 2);
  return found == feedback_.end() ? nullptr : &found->second;
}

bool KeyframeBuilder::Decide() {
  awaited_ = -1;
  while (const ImuSample* next = merger_.NextImu()) {
    const ImuSample sample = *next;
    if (!begun_) {
      if (merger_.has_events() && sample.t >= merger_.first_event()) Begin(sample);
      merger_.PopImu();
      continue;
    }
    const TrackerFeedback* const feedback = FeedbackForNext();
    if (feedback == nullptr) {
      awaited_ = next_seq_ - 2;
      return false;
    }
    const TrackerFeedback::Mode mode = photometric_ ? TrackerFeedback::Mode::kTracking : feedback->mode;
    const auto due =
        policy_.Due({mode, feedback->keyframe_stride, last_, sample.t, last_raw_.t,
                     merger_.PositionAfter(sample.t) - last_position_, static_cast<int>(imu_.size())});
    if (due) {
      Push(*due, sample, *feedback);
      if (*due == sample.t) {
        last_raw_ = sample;
        merger_.PopImu();
      }
      return true;
    }
    Take(sample);
    merger_.PopImu();
  }
  return false;
}

void KeyframeBuilder::Begin(const ImuSample& sample) {
  begun_ = first_ = true;
  last_ = sample.t;
  last_position_ = merger_.PositionAfter(sample.t);
  last_raw_ = sample;
  imu_.assign(1, sample);
  gap_ = 0;
}

void KeyframeBuilder::Take(const ImuSample& sample) {
  if (imu_.size() >= kMaxIntervalImu) {
    Begin(sample);
    return;
  }
  imu_.push_back(sample);
  gap_ = std::max(gap_, sample.t - last_raw_.t);
  last_raw_ = sample;
}

void KeyframeBuilder::Push(Utime stamp, const ImuSample& sample, const TrackerFeedback& feedback) {
  const ImuSample boundary = stamp == sample.t ? sample : InterpolateImu(last_raw_, sample, stamp);
  Pending pending;
  Keyframe& k = pending.keyframe;
  k.utime = stamp;
  k.seq = next_seq_++;
  k.previous_utime = first_ ? stamp : last_;
  k.high_rate = !photometric_ && KeyframePolicy::IsHighRate(feedback.mode);
  pending.position = merger_.PositionAfter(stamp);
  k.n_events = pending.position - last_position_;
  k.decay_us = policy_.DecayUs(feedback.image_speed);
  k.width = rig_.camera.width;
  k.height = rig_.camera.height;
  if (!first_) {
    imu_.push_back(boundary);
    k.imu = std::move(imu_);
    k.imu_gap = std::max(gap_, sample.t - last_raw_.t);
  }
  // Later events than this would not show: the faster the motion, the shorter the wait.
  k.lookahead = std::min(lookahead_, static_cast<Utime>(VisibleUs(k.decay_us, truncation_)));
  k.from_utime = k.utime;
  if (photometric_) {
    const Utime half = (k.utime - k.previous_utime) / 2;
    k.event_count = true;
    k.from_utime -= half;
    k.lookahead = std::min(lookahead_, half);
  }
  pending_.push_back(std::move(pending));

  imu_.assign(1, boundary);
  gap_ = 0;
  last_ = stamp;
  last_position_ = pending_.back().position;
  first_ = false;
  // Should the clock jump, the keyframes still pending are decided anew, from the feedback they had.
  feedback_.erase(feedback_.begin(), feedback_.lower_bound(next_seq() - 2));
}

void KeyframeBuilder::Apply(std::int64_t position) {
  const std::size_t begin = merger_.IndexOf(merger_.first()), end = merger_.IndexOf(position);
  const EventArray& e = merger_.events();
  surface_.Update(e.t.data() + begin, e.x.data() + begin, e.y.data() + begin, e.p.data() + begin,
                  end - begin);
  hot_pixels_.Update(e, begin, end);
  merger_.Release(position);
}

// Before Apply() gives up the events up to its stamp.
SurfaceRenderer::Image KeyframeBuilder::CountEvents(const Keyframe& k) {
  const auto index = [&](Utime t) {
    return merger_.IndexOf(std::max(merger_.first(), merger_.PositionAfter(t)));
  };
  return counter_.Count(merger_.events(), index(k.from_utime), index(k.utime + k.lookahead),
                        hot_pixels_.pixels());
}

Keyframe KeyframeBuilder::Draw(Pending pending) {
  Keyframe k = std::move(pending.keyframe);
  Stopwatch watch;
  if (k.event_count) {
    k.surface = CountEvents(k);
    k.render_ms = watch.Lap();
  }
  Apply(pending.position);
  hot_pixels_.AdvanceTo(k.utime);
  k.update_ms = watch.Lap();
  if (!k.event_count) {
    SurfaceRenderer::View view;
    view.t = k.utime;
    view.decay_us = k.decay_us;
    view.after = &merger_.events();
    view.begin = merger_.IndexOf(merger_.first());
    view.end = merger_.IndexOf(merger_.PositionAfter(k.utime + k.lookahead));
    view.ignored = &hot_pixels_.pixels();
    k.surface = renderer_.Render(surface_, view);
    k.render_ms = watch.Lap();
  }
  return k;
}

}  // namespace evit
