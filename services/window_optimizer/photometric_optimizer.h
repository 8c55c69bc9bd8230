#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/photometric/photometric_tracker.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "evit/keyframe_t.hpp"
#include "evit/map_view_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "evit/view_query_t.hpp"

namespace evit {

/// What window_optimizer is with method EVPT: KEYFRAME (event counts), MAP_VIEW and POSE_HINT in;
/// WINDOW_STATE, TRACKER_MODE and BODY_POSE for each keyframe and VIEW_QUERY out. The tracker itself is
/// common/photometric.
///
/// After each keyframe it asks map_server how the map looks from where the next one is expected. Lossless: a
/// keyframe waits for that view, and keyframes are taken in exact order. Real time: it waits no longer than
/// 50 ms, and of keyframes that queue up meanwhile only the newest are used.
class PhotometricOptimizer : public Service {
 public:
  struct Settings {
    Rig rig;
    PhotometricTrackerOptions tracker;
    SE3 T_map_body;  // of the body at the first keyframe
    bool lossless = false;
  };
  /// `bus` must outlive this.
  PhotometricOptimizer(Bus* bus, const Channels& channels, const Settings& settings);

  void Tick() override;
  void Stop() override { status_.SetState("finished", "stopped"); }

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    keyframe_t message;
    Clock::time_point arrived;
  };

  void OnKeyframe(const std::uint8_t* data, std::size_t size);
  void OnView(const std::uint8_t* data, std::size_t size);
  void OnPoseHint(const std::uint8_t* data, std::size_t size);
  bool Usable(const keyframe_t& message);
  bool InOrder(SequenceCounter::Verdict verdict, const keyframe_t& message);
  void AskForView();
  bool ReadyForNext() const;
  void ProcessQueue();
  void Report(const TrackerOutput& output, const Waiting& keyframe, double solve_ms);

  template <typename Message>
  void Send(const std::string& channel, Message* message, std::int64_t* seq);

  Bus* bus_;
  Channels channels_;
  Settings settings_;
  StatusReporter status_;
  SequenceCounter keyframes_, pose_hints_;
  PhotometricTracker tracker_;
  std::deque<Waiting> queue_;

  ViewQuery asked_view_;
  view_query_t query_{};
  bool answered_ = false;
  Clock::time_point asked_, first_asked_;

  std::pair<std::int64_t, std::int64_t> refused_{-1, -1};  // epoch and seq of the last keyframe out of order
  tracker_mode_t last_mode_{};
  std::int64_t window_seq_ = 0, mode_seq_ = 0, pose_seq_ = 0, query_seq_ = 0;
  std::vector<std::uint8_t> buffer_;
};

template <typename Message>
void PhotometricOptimizer::Send(const std::string& channel, Message* message, std::int64_t* seq) {
  message->seq = (*seq)++;
  message->epoch = status_.epoch();
  EncodeTo(*message, &buffer_);
  bus_->Publish(channel, buffer_.data(), buffer_.size());
}

}  // namespace evit
