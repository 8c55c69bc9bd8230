#include "tools/run/remote.h"

#include <unistd.h>

#include <limits>
#include <vector>

#include "common/bus/codec.h"
#include "common/bus/limits.h"
#include "common/service/status_reporter.h"

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
  for (int k = 0; k < 3; ++k) hint.position[k] = T_map_body.p[k];
  for (int k = 0; k < 4; ++k) hint.orientation[k] = T_map_body.q.coeffs()[k];
  std::vector<std::uint8_t> bytes;
  EncodeTo(hint, &bytes);
  bus_->Publish(channels_.pose_hint, bytes.data(), bytes.size());
}

}  // namespace evit::run
