#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/codec.h"

namespace evit {

/// One channel as its sender sees it: numbers the messages from 0 and marks them with the sender's epoch, so
/// that every reader can tell a gap and a restart from normal running.
template <typename Message>
class NumberedSender {
 public:
  /// `bus` must outlive this.
  NumberedSender(Bus* bus, std::string channel, std::int64_t epoch)
      : bus_(bus), channel_(std::move(channel)), epoch_(epoch) {}

  /// Sets seq and epoch of the message, and sends it.
  void Send(Message* message) {
    message->seq = next_seq_++;
    message->epoch = epoch_;
    SendAgain(*message);
  }

  /// Sends a message as it is, number and all: to whoever has missed it.
  void SendAgain(const Message& message) {
    EncodeTo(message, &buffer_);
    bus_->Publish(channel_, buffer_.data(), buffer_.size());
  }

 private:
  Bus* bus_;
  std::string channel_;
  std::int64_t epoch_;
  std::int64_t next_seq_ = 0;
  std::vector<std::uint8_t> buffer_;  // kept for its memory
};

}  // namespace evit
