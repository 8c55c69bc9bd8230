#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/photometric/photometric_tracker.h"
#include "common/service/runner.h"
#include "common/service/status_reporter.h"
#include "services/window_optimizer/keyframe_inbox.h"
#include "services/window_optimizer/keyframe_queue.h"
#include "services/window_optimizer/pose_hint_inbox.h"
#include "services/window_optimizer/request_client.h"
#include "services/window_optimizer/result_publisher.h"

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

  void OnKeyframe(const std::uint8_t* data, std::size_t size);
  void OnView(const std::uint8_t* data, std::size_t size);
  void OnPoseHint(const std::uint8_t* data, std::size_t size);
  void AskForView();
  bool ReadyForNext() const;
  void ProcessNext();
  void Report(const ProcessedKeyframe& processed);

  bool lossless_;
  StatusReporter status_;
  KeyframeInbox keyframe_inbox_;
  KeyframeQueue queue_;
  PoseHintInbox hints_;
  RequestClient<MapViewRequest> map_;
  ViewQuery asked_view_;  // the newest question to the map
  ResultPublisher publisher_;
  PhotometricTracker tracker_;
};

}  // namespace evit
