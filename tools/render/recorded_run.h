#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/log_file.h"
#include "evit/keyframe_t.hpp"
#include "evit/window_state_t.hpp"

namespace evit::render {

/// What `evit run --record` wrote: each window's newest state, and the keyframes to look up.
class RecordedRun {
 public:
  /// Throws std::runtime_error naming the file where it cannot be read or holds no WINDOW_STATE. `prefix`: of
  /// the channels.
  RecordedRun(const std::string& path, const std::string& prefix);

  /// In the order of their stamps; each has a node.
  const std::vector<window_state_t>& windows() const { return windows_; }
  /// us: the first keyframe, which is there before the first window; 0 of the film's time.
  std::int64_t begin() const;
  /// Index of the last window at or before t (us); the first one where there is none.
  std::size_t WindowAt(std::int64_t t) const;
  /// The keyframe with this stamp; nothing where it was not recorded.
  std::optional<keyframe_t> KeyframeAt(std::int64_t t) const;

 private:
  struct Place {
    std::int64_t utime;
    std::size_t entry;
  };
  LogReader log_;
  std::vector<window_state_t> windows_;
  std::vector<Place> keyframes_;  // sorted by utime
};

}  // namespace evit::render
