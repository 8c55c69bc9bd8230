#include "common/service/credit_sender.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/bus/codec.h"
#include "common/service/status_reporter.h"

namespace evit {

CreditSender::CreditSender(Bus* bus, const Channels& channels, const std::string& consumer,
                           std::int64_t epoch, std::function<std::int64_t()> clock)
    : bus_(bus), channel_(channels.credit), clock_(std::move(clock)), message_() {
  message_.epoch = epoch;
  message_.seq = 0;
  message_.consumer = consumer;
  message_.stream_epoch = -1;
  message_.next_events_seq = 0;
  message_.next_imu_seq = 0;
}

void CreditSender::Consumed(std::int64_t stream_epoch, std::int64_t next_events_seq,
                            std::int64_t next_imu_seq, std::size_t bytes) {
  if (stream_epoch != message_.stream_epoch) asked_ = true;
  message_.stream_epoch = stream_epoch;
  message_.next_events_seq = next_events_seq;
  message_.next_imu_seq = next_imu_seq;
  bytes_ += static_cast<std::int64_t>(bytes);
  if (bytes_ >= BytesPerCredit()) Send();
}

std::int64_t CreditSender::BytesPerCredit() const {
  // The sender's window is a quarter of the receive buffer. If that is small, so many bytes are never in
  // flight, and the stream would have to wait 50 ms for each credit.
  const std::int64_t buffer = bus_->granted_receive_buffer();
  return buffer > 0 ? std::clamp<std::int64_t>(buffer / 16, 4096, kBytes) : kBytes;
}

void CreditSender::Tick() {
  if (asked_ || clock_() - last_sent_us_ >= (bytes_ > 0 ? kBusyPeriodUs : kPeriodUs)) Send();
}

void CreditSender::Send() {
  message_.utime = HostTime();
  EncodeTo(message_, &buffer_);
  bus_->Publish(channel_, buffer_.data(), buffer_.size());
  ++message_.seq;
  bytes_ = 0;
  asked_ = false;
  last_sent_us_ = clock_();
}

std::int64_t SteadyTime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace evit
