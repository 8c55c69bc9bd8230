#include "services/log_replay/end_announcer.h"

#include <vector>

#include "common/bus/codec.h"

namespace evit {
namespace {

constexpr std::int64_t kSettleUs = 500'000;
constexpr std::int64_t kSettlingPeriodUs = 100'000;
constexpr std::int64_t kPeriodUs = 1'000'000;

}  // namespace

EndAnnouncer::EndAnnouncer(Bus* bus, const Channels& channels, const StreamSender* sender)
    : bus_(bus), channel_(channels.stream_end), sender_(sender) {}

void EndAnnouncer::Restart() { seq_ = said_us_ = delivered_us_ = 0; }

void EndAnnouncer::Tick(std::int64_t now_us, bool delivered, std::int64_t last_utime) {
  if (delivered_us_ == 0 && delivered) {
    delivered_us_ = now_us;
    said_us_ = 0;
  }
  if (said_us_ != 0 && now_us - said_us_ < (Settled(now_us) ? kPeriodUs : kSettlingPeriodUs)) return;
  stream_end_t message{};
  message.utime = sender_->last_utime(last_utime);
  message.seq = seq_++;
  message.epoch = sender_->epoch();
  message.n_events_messages = sender_->sent(Recording::kEvents);
  message.n_imu_messages = sender_->sent(Recording::kImu);
  std::vector<std::uint8_t> bytes;
  EncodeTo(message, &bytes);
  bus_->Publish(channel_, bytes.data(), bytes.size());
  said_us_ = now_us;
}

bool EndAnnouncer::Settled(std::int64_t now_us) const {
  return delivered_us_ != 0 && now_us - delivered_us_ >= kSettleUs;
}

}  // namespace evit
