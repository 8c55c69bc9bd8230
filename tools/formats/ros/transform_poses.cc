#include "tools/formats/ros/transform_poses.h"

#include <stdexcept>

#include "tools/formats/ros/message_types.h"

namespace evit::formats {
namespace {

// ROS 1's older tf wrote "/base_link" for "base_link".
std::string WithoutSlash(const std::string& frame) {
  return frame.rfind('/', 0) == 0 ? frame.substr(1) : frame;
}

}  // namespace

void TransformPoses::Add(RosCursor message) {
  const auto n = message.Get<std::uint32_t>("transforms");
  for (std::uint32_t k = 0; k < n; ++k) {
    std::string parent;
    StampedPose pose;
    pose.t = message.Header(&parent);
    Frame& frame = frames_[WithoutSlash(message.Text("child_frame_id"))];
    message.Doubles(3, pose.pose.p.data(), "transform.translation");
    message.Doubles(4, pose.pose.q.coeffs().data(), "transform.rotation");  // both x y z w
    parent = WithoutSlash(parent);
    if (frame.poses.empty()) frame.parent = parent;
    frame.one_parent = frame.one_parent && parent == frame.parent;
    frame.poses.push_back(pose);
  }
}

const std::vector<StampedPose>& TransformPoses::Of(const std::string& frame) const {
  if (frame.empty() && frames_.size() != 1)
    throw std::runtime_error("choose the frame whose poses are the truth with --truth-frame; frames: " +
                             Frames());
  const auto found = frame.empty() ? frames_.begin() : frames_.find(WithoutSlash(frame));
  if (found == frames_.end())
    throw std::runtime_error("--truth-frame " + frame + ": there is no such frame; frames: " + Frames());
  if (!found->second.one_parent)
    throw std::runtime_error(found->first + ": its poses are given in several frames; frames: " + Frames());
  return found->second.poses;
}

std::string TransformPoses::Frames() const {
  std::string list;
  for (const auto& [name, frame] : frames_)
    list.append(list.empty() ? "" : ", ").append(name).append(" (in ").append(frame.parent).append(")");
  return list.empty() ? "none" : list;
}

}  // namespace evit::formats
