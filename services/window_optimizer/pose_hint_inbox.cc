#include "services/window_optimizer/pose_hint_inbox.h"

#include <utility>

#include "common/bus/codec.h"

namespace evit {

void PoseHintInbox::OnMessage(const std::uint8_t* data, std::size_t size) {
  body_pose_t message;
  if (!DecodeChecked(data, size, &message)) {
    counter_.CountInvalid();
    return;
  }
  if (counter_.Accept(message.epoch, message.seq) == SequenceCounter::Verdict::kOld) return;
  const double* q = message.orientation;
  hint_ = SE3{Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(), Eigen::Vector3d(message.position)};
}

std::optional<SE3> PoseHintInbox::Take() { return std::exchange(hint_, std::nullopt); }

}  // namespace evit
