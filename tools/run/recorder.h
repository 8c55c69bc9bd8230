#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/evaluation/covariance_file.h"
#include "common/evaluation/trajectory.h"
#include "evit/service_status_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "evit/window_state_t.hpp"

namespace evit::run {

/// Listens to a run: keeps the trajectories, mode changes and each service's last STATUS, and knows when it
/// is over.
class Recorder {
 public:
  struct ModeChange {
    Utime t = 0;
    int mode = 0;
    std::string reason;
  };

  /// `bus` must outlive this.
  Recorder(Bus* bus, const Channels& channels);

  /// Every keyframe's pose as it was first estimated.
  const Trajectory& online() const { return online_; }
  /// Its covariance, one for each of online().
  const Covariances& covariances() const { return covariances_; }
  /// Every keyframe's pose as it left the window; those still in it as they are now.
  Trajectory smoothed() const;

  /// Forgets the trajectories: the log is played again.
  void StartOver();

  const std::vector<ModeChange>& mode_changes() const { return mode_changes_; }
  const tracker_mode_t& mode() const { return mode_; }
  std::int64_t n_keyframes() const { return earlier_keyframes_ + mode_.keyframe_seq + 1; }
  const std::map<std::string, service_status_t>& statuses() const { return statuses_; }
  double progress() const;
  /// log_replay says that it waits for an order to continue.
  bool paused() const;

  /// Mean milliseconds of the optimiser, over all keyframes with a pose.
  double mean_solve_ms() const {
    return online_.empty() ? 0 : solve_ms_ / static_cast<double>(online_.size());
  }

  /// A service of whose STATUS two epochs come in turn: another pipeline is on this bus. Empty: none.
  const std::string& two_senders() const { return two_senders_; }

  /// frame_builder has used everything and the tracker has answered its last keyframe.
  bool Finished() const;
  /// Something came since the last call (to notice silence).
  bool TakeActivity();

 private:
  void OnStatus(const service_status_t& message);
  void OnWindow(const window_state_t& message);
  void OnMode(const tracker_mode_t& message);

  Trajectory online_;
  Covariances covariances_;
  std::map<Utime, StampedPose> window_;  // those in the window; keyframe numbers restart with frame_builder
  Trajectory left_;
  std::vector<ModeChange> mode_changes_;
  tracker_mode_t mode_{};
  std::int64_t earlier_keyframes_ = 0;  // of earlier runs of frame_builder
  std::map<std::string, service_status_t> statuses_;
  std::map<std::string, std::set<std::int64_t>> epochs_;  // of each service, that are over
  std::string two_senders_;
  int turns_ = 0;  // how often an epoch that was over spoke
  double solve_ms_ = 0;
  bool active_ = false;
};

/// What the services say of themselves, for messages: "status of the services:", then a line for each.
std::string StatusText(const Recorder& recorder);

/// A STATUS counter by name; 0 where there is none.
std::int64_t CounterOf(const service_status_t& status, const std::string& name);

}  // namespace evit::run
