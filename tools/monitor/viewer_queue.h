#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "tools/monitor/frame.h"

namespace evit::monitor {

/// What waits to be sent to one viewer. Bounded: of a picture, a pose or a table only the newest is kept; of
/// a series (window states, for plots) the newest 512. A picture is sent only while at most one that went
/// before it has not been acknowledged, so that pictures never pile up in the network's buffers: a slow
/// viewer sees fewer of them, not older ones.
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

  bool wants_picture() const { return unacknowledged_ < kPicturesUnderWay && !picture_; }
  std::int64_t dropped() const { return dropped_; }
  /// Whether Next() gives a frame now.
  bool ready() const;

 private:
  static constexpr int kPicturesUnderWay = 2;
  static constexpr std::size_t kLongestSeries = 512;

  std::map<std::string, FramePtr> newest_;
  std::deque<FramePtr> series_;
  FramePtr picture_;
  int unacknowledged_ = 0;
  std::int64_t dropped_ = 0;
};

}  // namespace evit::monitor
