#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "common/events/active_event_surface.h"
#include "common/events/event_counter.h"
#include "common/events/hot_pixels.h"
#include "common/events/keyframe_policy.h"
#include "common/events/stream_merger.h"
#include "common/events/surface_renderer.h"
#include "common/geometry/rig.h"

namespace evit {

/// One keyframe: the surface at its stamp and the IMU samples since the one before (see keyframe_t).
struct Keyframe {
  Utime utime = 0;
  std::int64_t seq = 0;
  Utime previous_utime = 0;  // utime itself where there is no keyframe before
  bool high_rate = false;
  std::int64_t n_events = 0;
  double decay_us = 0;
  Utime lookahead = 0;       // us: events up to utime + this count
  bool event_count = false;  // the surface holds signed counts (EventCounter), of the events after from_utime
  Utime from_utime = 0;
  int width = 0, height = 0;
  SurfaceRenderer::Image surface;
  std::vector<ImuSample> imu;  // from previous_utime to utime, both interpolated where needed; empty if first
  Utime imu_gap = 0;           // us: longest distance between two raw samples of the interval

  double update_ms = 0, render_ms = 0;  // how long making it took
};

/// Events and IMU samples in, keyframes out (paper Sec. III-B). Feed what there is, then take what Next()
/// gives:
///   builder.AddEvents(...); builder.AddImu(...);
///   while (auto keyframe = builder.Next()) { ...; builder.SetFeedbackFor(keyframe->seq, feedback); }
///
/// Lossless: keyframes depend on the data and on the feedback only, bit for bit, not on how the two streams
/// are cut or interleaved: keyframe k is made with the feedback of keyframe k-2 (k < 2: defaults), and waits
/// for it. Real time: the newest feedback counts, and an IMU 50 ms ahead of the events does not wait for
/// them.
///
/// EVPT: signed event counts in place of time surfaces, over half of the interval before and as long after
/// the stamp, and adaptive keyframes whatever the tracker's mode.
class KeyframeBuilder {
 public:
  struct Options {
    KeyframeOptions keyframes;
    SurfaceOptions surface;
    bool event_counts = false;  // EVPT
  };
  KeyframeBuilder(const Rig& rig, const Options& options, bool lossless);

  /// Sorted events in the camera's clock (the rig's time offset is added here). No event before `watermark`
  /// is still to come: the last event's stamp, or more where that is known (empty packets).
  void AddEvents(const EventArray& events, Utime watermark);
  void AddImu(const ImuSample& sample);
  /// What the tracker says after keyframe `seq`.
  void SetFeedbackFor(std::int64_t seq, const TrackerFeedback& feedback);
  /// Both streams have ended: the last keyframes need not wait for later events.
  void Flush() { merger_.Flush(); }
  /// Forgets the streams (a new one begins). Numbers of keyframes go on.
  void Reset();

  std::optional<Keyframe> Next();

  /// After Next() gave none: number of the keyframe whose feedback it waits for before it can use any more
  /// data; -1: it waits for data.
  std::int64_t awaited_feedback() const { return pending_.empty() ? awaited_ : -1; }
  std::int64_t next_seq() const { return next_seq_ - static_cast<std::int64_t>(pending_.size()); }

  const StreamMerger::Counters& counters() const { return merger_.counters(); }
  std::int64_t events_overrun() const { return events_overrun_; }

 private:
  struct Pending {  // decided, not drawn yet
    Keyframe keyframe;
    std::int64_t position;  // events before it belong to the surface
  };
  bool Decide();
  void Begin(const ImuSample& sample);
  void Take(const ImuSample& sample);
  void Push(Utime stamp, const ImuSample& sample, const TrackerFeedback& feedback);
  Keyframe Draw(Pending pending);
  SurfaceRenderer::Image CountEvents(const Keyframe& keyframe);
  void Apply(std::int64_t position);
  void LimitMemory();
  const TrackerFeedback* FeedbackForNext() const;
  void Restart();

  Rig rig_;
  bool lossless_;
  bool photometric_;
  Utime lookahead_;  // at most
  double truncation_;
  KeyframePolicy policy_;
  StreamMerger merger_;
  ActiveEventSurface surface_;
  HotPixels hot_pixels_;
  SurfaceRenderer renderer_;
  EventCounter counter_;

  std::deque<Pending> pending_;
  std::int64_t next_seq_ = 0, awaited_ = -1;

  bool begun_ = false, first_ = true;  // first: no keyframe before
  Utime last_ = 0;                     // stamp of the last keyframe decided
  std::int64_t last_position_ = 0;     // events up to it
  std::vector<ImuSample> imu_;         // since last_, which is its first
  ImuSample last_raw_;                 // newest sample used
  Utime gap_ = 0;

  TrackerFeedback default_, newest_;
  std::map<std::int64_t, TrackerFeedback> feedback_;
  std::int64_t events_overrun_ = 0;
};

}  // namespace evit
