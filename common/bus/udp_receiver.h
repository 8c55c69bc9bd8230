#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/lcm_url.h"
#include "common/bus/message_assembler.h"

namespace evit {

/// A socket of LCM's multicast group, read by the thread that asks.
class UdpReceiver {
 public:
  /// `receive_buffer`: bytes to ask of the kernel. Throws std::runtime_error where the group cannot be
  /// joined.
  UdpReceiver(const LcmUrl& url, int receive_buffer);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// From now on these channels alone (channel_filter.h).
  void Hear(const std::vector<std::string>& channels);

  /// Waits until something is there, `timeout_ms` at most, or until a signal comes. False: nothing is.
  bool Wait(int timeout_ms) const;
  /// Reads on until a message is whole. False: nothing more is there. What `message` shows is valid until the
  /// next call.
  bool Read(MessageAssembler::Message* message);

  /// Exchanges the memory that holds the message just read for other. `begin`: of its data in that memory.
  void ExchangeMemory(const MessageAssembler::Message& message, std::vector<std::uint8_t>* memory,
                      std::size_t* begin);

 private:
  int socket_;
  MessageAssembler assembler_;
  std::vector<std::uint8_t> datagram_;
};

}  // namespace evit
