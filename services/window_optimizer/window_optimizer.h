#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/localization/locating_tracker.h"
#include "common/service/runner.h"
#include "common/service/status_reporter.h"
#include "common/tracking/map_tracker.h"
#include "services/window_optimizer/imu_inbox.h"
#include "services/window_optimizer/imu_rate_pose.h"
#include "services/window_optimizer/keyframe_inbox.h"
#include "services/window_optimizer/keyframe_queue.h"
#include "services/window_optimizer/load_limiter.h"
#include "services/window_optimizer/map_client.h"
#include "services/window_optimizer/place_client.h"
#include "services/window_optimizer/pose_hint_inbox.h"
#include "services/window_optimizer/restart_coordinator.h"
#include "services/window_optimizer/result_publisher.h"
#include "services/window_optimizer/tracker_worker.h"

namespace evit {

/// KEYFRAME, IMU, MAP_POINTS and POSE_HINT in; WINDOW_STATE and TRACKER_MODE for each keyframe, BODY_POSE for
/// each IMU sample (without an IMU for each keyframe) and MAP_QUERY out. The tracker itself is
/// common/tracking.
///
/// The points for the next keyframe are asked for before one is processed, so that map_server works
/// meanwhile, and only where the view has moved so far that those at hand do not suffice. Lossless: a
/// keyframe waits for that answer, and keyframes are taken in exact order. Real time: nothing waits longer
/// than 20 ms for an answer, work is cut down while keyframes wait (LoadLimiter), and the IMU samples of a
/// keyframe that was dropped all the same are bridged from the service's own. Restarted with a checkpoint it
/// asks frame_builder for the keyframes since and continues as if nothing had been (RestartCoordinator).
class WindowOptimizer : public Service {
 public:
  struct Settings {
    Rig rig;
    TrackerOptions tracker;
    SE3 T_map_body;  // of the body at the first keyframe
    bool lossless = false;
    std::string checkpoint;                          // file; real time only; empty: none
    std::optional<LocatingTracker::Options> locate;  // finds the place itself; empty: never
  };
  /// `bus` must outlive this.
  WindowOptimizer(Bus* bus, const Channels& channels, const Settings& settings);

  void Tick() override;
  void Stop() override;
  int poll_timeout_ms() const override { return worker_.working() ? 1 : 10; }  // a result does not wait long
  /// A keyframe waits or is in work.
  bool busy() const { return worker_.working() || !queue_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  void OnKeyframe(const std::uint8_t* data, std::size_t size);
  void OnMapPoints(const std::uint8_t* data, std::size_t size);
  void OnImu(const std::uint8_t* data, std::size_t size);
  void OnPlaces(const std::uint8_t* data, std::size_t size);
  void OnPoseHint(const std::uint8_t* data, std::size_t size);

  void ProcessQueue();
  bool ReadyForNext() const;
  void StartWork(QueuedKeyframe next);
  void LimitWork(const QueuedKeyframe& next, bool tracking);
  KeyframeInput InputOf(const keyframe_t& keyframe);
  bool FinishWork(TrackerWorker::Wait wait);
  void Report(const ProcessedKeyframe& processed);
  void PublishKeyframePose(const ProcessedKeyframe& processed);
  void PublishPoses(const std::vector<ImuSample>& samples, const BodyState& from);

  void AskForPoints();
  void UsePoints();
  void UseHint();
  void CatchUp();
  void StartFromCheckpoint();

  Settings settings_;
  StatusReporter status_;
  KeyframeInbox keyframe_inbox_;
  KeyframeQueue queue_;
  ImuInbox imu_;
  ImuRatePose imu_rate_pose_;  // real time only
  PoseHintInbox hints_;
  MapClient map_;
  PlaceClient places_;
  LoadLimiter load_;  // real time only
  RestartCoordinator restart_;
  ResultPublisher publisher_;
  TrackerWorker worker_;
  bool asked_ahead_ = false;  // for the points of the keyframe after the one in work
};

}  // namespace evit
