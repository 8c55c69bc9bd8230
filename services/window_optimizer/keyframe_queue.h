#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "evit/keyframe_t.hpp"

namespace evit {

/// A keyframe message, and when it came.
struct QueuedKeyframe {
  keyframe_t message;
  std::chrono::steady_clock::time_point arrived;
};

/// The keyframes that wait for the tracker: which are admitted, in which order, and which go where too many
/// wait. Counts KEYFRAME.received, .lost, .duplicate and so on (SequenceCounter), .out_of_order, .dropped
/// and .superseded in STATUS.
///
/// Lossless: exactly the next one is admitted, and none is dropped. Real time: all that are new; the oldest
/// go where more wait than there is room for.
class KeyframeQueue {
 public:
  using Clock = std::chrono::steady_clock;

  struct Options {
    bool lossless = false;
    std::size_t capacity = 4;         // real time
    std::size_t burst_capacity = 32;  // the same while frames of a burst wait (bootstrapping, a restart)
    bool merge_imu = true;            // a dropped keyframe leaves its IMU samples to the next one
  };
  /// `status` must outlive this.
  KeyframeQueue(StatusReporter* status, const Options& options);

  enum class Admission {
    kQueued,
    kOutOfOrder,  // lossless: frame_builder sends the missing one again
    kOld          // taken before: sent again because the answer to it got lost
  };
  Admission Admit(keyframe_t keyframe, Clock::time_point now);
  /// Keyframes collected elsewhere, which follow each other.
  void AdmitCollected(std::vector<keyframe_t> keyframes, Clock::time_point now);
  /// Those up to number `seq`, and some that come meanwhile, are late because of a restart.
  void ExpectBurstUpTo(std::int64_t seq);

  /// Real time: leaves out high-rate frames that a newer one follows.
  void DropSuperseded();

  bool empty() const { return keyframes_.empty(); }
  std::size_t size() const { return keyframes_.size(); }
  const QueuedKeyframe& front() const { return keyframes_.front(); }
  QueuedKeyframe Pop();
  /// Late because of a restart, not because of the tracker's load.
  bool LateByRestart(const keyframe_t& keyframe) const { return keyframe.seq <= burst_until_; }

 private:
  bool IsNext(const keyframe_t& keyframe) const;
  bool OldestIsOfABurst() const;
  void Push(keyframe_t keyframe, Clock::time_point now);
  void DropOldest(keyframe_t* next);

  Options options_;
  StatusReporter* status_;
  SequenceCounter counter_;
  std::deque<QueuedKeyframe> keyframes_;
  std::pair<std::int64_t, std::int64_t> rejected_{-1, -1};  // epoch and seq: the last from an unknown sender
  std::int64_t burst_until_ = -1;                           // number of a keyframe; -1: no burst
};

}  // namespace evit
