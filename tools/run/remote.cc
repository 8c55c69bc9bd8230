#include "tools/run/remote.h"

#include <unistd.h>

#include <limits>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/limits.h"
#include "common/service/status_reporter.h"
#include "common/wire/geometry_wire.h"

namespace evit::run {

Remote::Remote(Bus* bus, const Channels& channels) : bus_(bus), channels_(channels), epoch_(NewEpoch()) {}

void Remote::Order(std::int8_t command) {
  replay_control_t order{};
  order.utime = HostTime();
  order.command = command;
  order.epoch = epoch_;
  order.seq = order_seq_++;
  order.seek_utime = -kMaxTime;  // SEEK: before everything
  std::vector<std::uint8_t> bytes;
  EncodeTo(order, &bytes);
  bus_->Publish(channels_.replay_control, bytes.data(), bytes.size());
}

void Remote::Resume() { Order(replay_control_t::RESUME); }
void Remote::Rewind() { Order(replay_control_t::SEEK); }

void Remote::HintPose(const SE3& T_map_body) {
  body_pose_t hint{};
  hint.utime = HostTime();
  hint.epoch = epoch_;
  hint.seq = hint_seq_++;
  PutPose(T_map_body, &hint);
  std::vector<std::uint8_t> bytes;
  EncodeTo(hint, &bytes);
  bus_->Publish(channels_.pose_hint, bytes.data(), bytes.size());
}

}  // namespace evit::run
