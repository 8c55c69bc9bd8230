#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "common/events/event_clock.h"
#include "common/events/feedback_schedule.h"
#include "common/events/imu_interval.h"
#include "common/events/keyframe.h"
#include "common/events/keyframe_image.h"
#include "common/events/keyframe_options.h"
#include "common/events/keyframe_policy.h"
#include "common/events/stream_merger.h"
#include "common/geometry/rig.h"

namespace evit {

/// Events and IMU samples in, keyframes out (paper Sec. III-B). Feed what there is, then take what Next()
/// gives:
///   builder.AddEvents(...); builder.AddImu(...);
///   while (auto keyframe = builder.Next()) { ...; builder.SetFeedbackFor(keyframe->seq, feedback); }
///
/// Lossless: keyframes depend on the data and on the feedback only, bit for bit, not on how the two streams
/// are cut or interleaved (whether an IMU comes within the patience of Options::imu_patience is asked of the
/// order of messages): each waits for its feedback (FeedbackSchedule). Real time: the newest feedback
/// counts, and an IMU 50 ms ahead of the events does not wait for them.
///
/// Without an IMU there are no keyframes, unless Options::without_imu is set.
class KeyframeBuilder {
 public:
  struct Options {
    KeyframeOptions keyframes;
    SurfaceOptions surface;
    /// kEventCount also makes keyframes adaptive whatever the tracker's mode.
    Keyframe::Encoding encoding = Keyframe::Encoding::kTimeSurface;
    /// Where no IMU sample comes within `imu_patience` (us of events; 0: none is waited for), keyframes come
    /// by the events' own clock, without IMU samples; what an IMU says later does not count. Lossless they
    /// begin at the first event. For trackers that need none.
    bool without_imu = false;
    Utime imu_patience = EventClock::kPatience;
  };
  KeyframeBuilder(const Rig& rig, const Options& options, bool lossless);

  /// Sorted events in the camera's clock (the rig's time offset is added here). No event before `watermark`
  /// is still to come: the last event's stamp, or more where that is known (empty packets).
  void AddEvents(const EventArray& events, Utime watermark);
  void AddImu(const ImuSample& sample);
  /// What the tracker says after keyframe `seq`.
  void SetFeedbackFor(std::int64_t seq, const TrackerFeedback& feedback) { feedback_.Set(seq, feedback); }
  /// Both streams have ended: the last keyframes need not wait for later events.
  void Flush() { merger_.Flush(); }
  /// Forgets the streams (a new one begins). Numbers of keyframes continue.
  void Reset();

  std::optional<Keyframe> Next();

  /// After Next() gave none: number of the keyframe whose feedback it waits for before it can use any more
  /// data; -1: it waits for data.
  std::int64_t awaited_feedback() const { return pending_.empty() ? awaited_ : -1; }
  std::int64_t next_seq() const { return next_seq_ - static_cast<std::int64_t>(pending_.size()); }

  const StreamMerger::Counters& counters() const { return merger_.counters(); }
  std::int64_t events_overrun() const { return events_overrun_; }  // passed over: too many waited

 private:
  struct Pending {  // decided, not drawn yet
    Keyframe keyframe;
    std::int64_t position;  // of the first event after its stamp
  };
  std::optional<ImuSample> NextSample();
  void PopSample();
  bool Decide();
  void Begin(const ImuSample& sample);
  void Take(const ImuSample& sample);
  void Push(Utime stamp, const ImuSample& sample, const TrackerFeedback& feedback);
  Keyframe Draw(Pending pending);
  void LimitMemory();
  void Restart();

  int width_, height_;
  bool without_imu_;
  KeyframePolicy policy_;
  StreamMerger merger_;
  EventClock clock_;  // where there is no IMU
  std::unique_ptr<KeyframeImage> image_;
  FeedbackSchedule feedback_;
  ImuInterval interval_;  // since the last keyframe decided
  std::deque<Pending> pending_;
  std::int64_t next_seq_ = 0, awaited_ = -1;
  bool first_ = true;               // no keyframe before
  std::int64_t last_position_ = 0;  // of the first event after the last keyframe decided
  std::int64_t events_overrun_ = 0;
};

}  // namespace evit
