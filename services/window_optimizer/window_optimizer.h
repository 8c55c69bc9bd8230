#pragma once

#include <chrono>
#include <deque>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "common/tracking/tracker.h"
#include "evit/keyframe_t.hpp"
#include "evit/map_points_t.hpp"
#include "evit/map_query_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "services/window_optimizer/catch_up.h"
#include "services/window_optimizer/checkpoint.h"
#include "services/window_optimizer/imu_history.h"
#include "services/window_optimizer/load_governor.h"

namespace evit {

/// KEYFRAME, IMU, MAP_POINTS and POSE_HINT in; WINDOW_STATE and TRACKER_MODE for each keyframe, BODY_POSE for
/// each IMU sample and MAP_QUERY out. The tracker itself is common/tracking.
///
/// The points for the next keyframe are asked for before one is processed, so that map_server works
/// meanwhile. Lossless: a keyframe waits for that answer, and keyframes are taken in exact order. Real time:
/// nothing waits longer than kAnswerPatience, work is cut down while keyframes wait (LoadGovernor), and the
/// IMU samples of a keyframe that was dropped all the same are bridged from the service's own. Restarted with
/// a checkpoint it asks frame_builder for the keyframes since and goes on as if nothing had been
/// (restart.cc).
class WindowOptimizer : public Service {
 public:
  struct Settings {
    Rig rig;
    TrackerOptions tracker;
    SE3 T_map_body;  // of the body at the first keyframe
    bool lossless = false;
    std::string checkpoint;  // file; real time only; empty: none
  };
  /// `bus` must outlive this.
  WindowOptimizer(Bus* bus, const Channels& channels, const Settings& settings);

  void Tick() override;
  void Stop() override;
  int poll_timeout_ms() const override { return work_ ? 1 : 10; }  // a finished keyframe does not wait long
  /// A keyframe waits or is in work.
  bool busy() const { return work_.has_value() || !queue_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  void OnKeyframe(const std::uint8_t* data, std::size_t size);
  void OnMapPoints(const std::uint8_t* data, std::size_t size);
  void OnImu(const std::uint8_t* data, std::size_t size);
  void OnPoseHint(const std::uint8_t* data, std::size_t size);
  void TakeHint();
  bool InOrder(SequenceCounter::Verdict verdict, const keyframe_t& message);
  void Queue(keyframe_t message);
  struct Waiting {
    keyframe_t message;
    Clock::time_point arrived;
  };
  void ProcessQueue();
  bool Resumed();
  void CatchUp();
  void AnnounceCheckpoint();
  void DropSuperseded();
  void StartWork(Waiting next);
  /// False where it is not done and `wait` is not set.
  bool FinishWork(bool wait);
  void Govern(double waited_ms);
  bool ReadyForNext() const;
  void AskForPoints(const VisibilityQuery& query);
  void AskAgain();
  void Report(const TrackerOutput& output, const keyframe_t& message, double solve_ms,
              Clock::time_point arrived);
  void PublishPoses(const std::vector<ImuSample>& samples, NavState from, const ImuBias& bias);

  template <typename Message>
  void Send(const std::string& channel, Message* message, std::int64_t* seq);

  Bus* bus_;
  Channels channels_;
  Settings settings_;
  StatusReporter status_;
  SequenceCounter keyframes_;
  SequenceCounter imu_messages_;
  SequenceCounter pose_hints_;
  Tracker tracker_;
  ImuHistory imu_;
  LoadGovernor governor_;  // real time only

  std::deque<Waiting> queue_;
  Clock::time_point last_arrived_;  // of the keyframe in work

  map_query_t query_{};
  bool answered_ = false;
  Clock::time_point unanswered_since_ = Clock::now();  // map_server has not been heard since, though asked
  Clock::time_point asked_;
  Clock::time_point first_asked_;

  std::pair<std::int64_t, std::int64_t> refused_{-1, -1};  // epoch and seq of the last keyframe out of order
  tracker_mode_t last_mode_{};
  std::optional<CheckpointFile> checkpoint_file_;
  std::optional<Checkpoint> checkpoint_;     // to go on from, until the first keyframe
  std::optional<KeyframeCatchUp> catch_up_;  // until the keyframes since then are here
  Clock::time_point announced_;              // the checkpoint
  std::int64_t caught_up_ = -1;              // number of the newest of those keyframes
  NavState live_;                            // where IMU-rate poses start from, real-time mode
  ImuBias live_bias_;
  Utime live_time_ = 0;
  std::int64_t window_seq_ = 0, mode_seq_ = 0, pose_seq_ = 0, query_seq_ = 0;
  std::vector<std::uint8_t> buffer_;

  /// The keyframe that tracker_ is busy with. Last member: its thread ends before anything else is gone.
  struct Work {
    keyframe_t keyframe;
    Clock::time_point arrived;
    bool asked;                                            // for the points of the next keyframe
    std::future<std::pair<TrackerOutput, double>> result;  // with ms
  };
  std::optional<map_points_t> answer_;  // came meanwhile
  std::optional<SE3> hint_;             // the same
  std::optional<Work> work_;
};

template <typename Message>
void WindowOptimizer::Send(const std::string& channel, Message* message, std::int64_t* seq) {
  message->seq = (*seq)++;
  message->epoch = status_.epoch();
  EncodeTo(*message, &buffer_);
  bus_->Publish(channel, buffer_.data(), buffer_.size());
}

}  // namespace evit
