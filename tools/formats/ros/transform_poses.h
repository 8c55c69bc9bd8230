#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"
#include "tools/formats/ros/ros_cursor.h"

namespace evit::formats {

/// Poses of the frames of a topic of TFMessage (/tf): each message holds transforms of any number of frames.
class TransformPoses {
 public:
  /// Takes a message's transforms; throws std::runtime_error naming the field that does not fit.
  void Add(RosCursor message);

  /// Poses of `frame` (child_frame_id) in its parent frame, as they came, quaternions as they stand; empty:
  /// of the only frame there is. Throws std::runtime_error that lists the frames: there is no such, there are
  /// several, or its parent changes.
  const std::vector<StampedPose>& Of(const std::string& frame) const;

 private:
  struct Frame {
    std::string parent;
    bool one_parent = true;
    std::vector<StampedPose> poses;
  };
  std::string Frames() const;

  std::map<std::string, Frame> frames_;
};

}  // namespace evit::formats
