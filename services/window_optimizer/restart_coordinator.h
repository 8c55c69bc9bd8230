#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "evit/keyframe_t.hpp"
#include "evit/tracker_mode_t.hpp"
#include "services/window_optimizer/checkpoint.h"
#include "services/window_optimizer/keyframe_catch_up.h"

namespace evit {

/// Continues a run that died. Keeps the newest checkpoint in a file; started again, it announces what it
/// found there until frame_builder has sent the keyframes since, and collects them. If they are gone, the
/// checkpoint still says where the body must be at the first keyframe that comes.
class RestartCoordinator {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr auto kAnnounceAgain = std::chrono::milliseconds(50);
  static constexpr Utime kLongestPrediction = 3'000'000;  // us: beyond that it is worth nothing

  /// An empty name: nothing is kept and nothing continued. Throws std::runtime_error where the file cannot
  /// be written.
  explicit RestartCoordinator(const std::string& checkpoint_file);

  /// Where the run before was; none once the tracker has continued from there.
  const std::optional<Checkpoint>& checkpoint() const { return checkpoint_; }
  /// Keyframes are to be collected.
  bool collecting() const { return catch_up_.has_value(); }

  /// While collecting.
  void Collect(keyframe_t keyframe, Clock::time_point now);
  KeyframeCatchUp::Progress ProgressAt(Clock::time_point now) const { return catch_up_->ProgressAt(now); }
  bool AnnouncementDue(Clock::time_point now) const { return now - announced_ > kAnnounceAgain; }
  /// TRACKER_MODE, which tells frame_builder the last keyframe that was processed, as the answer to it did:
  /// it sends those since again.
  tracker_mode_t Announce(Clock::time_point now);
  /// Ends collecting: the keyframes, in order. The checkpoint stays.
  std::vector<keyframe_t> TakeKeyframes();

  /// If the keyframes since the checkpoint are gone: where the body must be at time `t` (us). None if that is
  /// before the checkpoint or too long after it.
  std::optional<BodyState> PredictedAt(Utime t) const;

  /// Ends the restart: the checkpoint has been used, or is of no use.
  void Done();

  /// Whether checkpoints are stored: of the newest keyframe, for the next restart.
  bool enabled() const { return file_.has_value(); }
  void Store(const Checkpoint& checkpoint) { file_->Store(checkpoint); }

 private:
  std::optional<CheckpointFile> file_;
  std::optional<Checkpoint> checkpoint_;
  std::optional<KeyframeCatchUp> catch_up_;
  Clock::time_point announced_;
};

}  // namespace evit
