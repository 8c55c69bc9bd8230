#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "tools/monitor/frame.h"

namespace evit::monitor {

/// What waits to be sent to one viewer. Bounded: of a picture, a pose or a table only the newest is kept; of
/// a series (window states, for plots) the newest 512. A picture is sent only when the one before it has been
/// acknowledged: a slow viewer sees fewer of them, not older ones.
class ViewerQueue {
 public:
  /// Takes the place of what waits under the same name.
  void Replace(const std::string& name, FramePtr frame);
  /// The same, for frames that the viewer acknowledges.
  void ReplacePicture(FramePtr frame);
  /// Behind all others of the series; the oldest gives way where there are 512.
  void Append(FramePtr frame);

  /// The next frame to send; null where there is none, or none that may be sent now. Small ones go first.
  FramePtr Next();
  /// The viewer has drawn a picture.
  void Acknowledge();

  bool wants_picture() const { return !under_way_ && !picture_; }
  std::int64_t dropped() const { return dropped_; }
  /// Whether Next() gives a frame now.
  bool ready() const;

 private:
  static constexpr std::size_t kLongestSeries = 512;

  std::map<std::string, FramePtr> newest_;
  std::deque<FramePtr> series_;
  FramePtr picture_;
  bool under_way_ = false;  // a picture that has not been acknowledged
  std::int64_t dropped_ = 0;
};

}  // namespace evit::monitor
