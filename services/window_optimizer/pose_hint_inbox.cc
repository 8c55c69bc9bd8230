#include "services/window_optimizer/pose_hint_inbox.h"

#include <utility>

#include "common/bus/codec.h"
#include "common/wire/geometry_wire.h"

namespace evit {

void PoseHintInbox::OnMessage(const std::uint8_t* data, std::size_t size) {
  body_pose_t message;
  if (!DecodeChecked(data, size, &message)) {
    counter_.CountInvalid();
    return;
  }
  if (counter_.Commit(message.epoch, message.seq) == SequenceCounter::Verdict::kOld) return;
  hint_ = PoseOf(message);
}

std::optional<SE3> PoseHintInbox::Take() { return std::exchange(hint_, std::nullopt); }

}  // namespace evit
