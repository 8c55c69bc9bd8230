#pragma once

namespace evit {

/// Overload policy of real-time mode: how much a keyframe may cost, from how long keyframes wait.
///
/// In this order, one step at a time: half the points, a quarter of the points, then keyframes of twice and
/// of four times as many events (TRACKER_MODE.keyframe_stride). Points go first: the error grows with the
/// square root of their number only, while sparser keyframes cost latency too. What still does not fit is
/// dropped from the queue, oldest first, and counted. Back one step after two seconds or so without waiting.
class LoadGovernor {
 public:
  static constexpr int kMaxLevel = 4;

  /// A keyframe begins to be processed after waiting so long (ms).
  void Observe(double waited_ms);

  /// Longest time (s) one solve may take, so that the best so far counts: a share of the time between two
  /// keyframes (s), within limits, and the least while others wait.
  static double SolveBudget(double interval, bool others_wait);

  int level() const { return level_; }
  double point_share() const { return level_ == 0 ? 1.0 : level_ == 1 ? 0.5 : 0.25; }
  double keyframe_stride() const { return level_ <= 2 ? 1 : level_ == 3 ? 2 : 4; }

 private:
  int level_ = 0;
  int late_ = 0;  // keyframes that waited, less those that did not
  int idle_ = 0;  // keyframes in a row that did not wait at all
};

}  // namespace evit
