#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "evit/body_pose_t.hpp"
#include "evit/window_state_t.hpp"
#include "tools/monitor/frame.h"

namespace evit::monitor {

/// The last minute of a run, ten samples a second: what a page that is opened later shows of the past. At
/// most 600 window states and 600 true poses, 200 kB. Where the sensor's time goes back (a replay was
/// rewound) the past is forgotten.
class RunHistory {
 public:
  /// `frame`: the state as EncodeWindow() makes it.
  void AddWindow(const window_state_t& window, FramePtr frame) {
    Add(window.utime, std::move(frame), &windows_);
  }
  /// `frame`: the pose as EncodePose() makes it.
  void AddTruth(const body_pose_t& pose, FramePtr frame) { Add(pose.utime, std::move(frame), &truths_); }

  /// kind u32, windows u32, truths u32, 0 u32, then that many frames of each kind, oldest first, as they were
  /// sent. Null: nothing has been heard.
  FramePtr Encode() const;

 private:
  using Series = std::deque<std::pair<std::int64_t, FramePtr>>;  // us, sensor clock
  static void Add(std::int64_t utime, FramePtr frame, Series* to);

  Series windows_, truths_;
};

}  // namespace evit::monitor
