#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace evit::feed {

/// Where the bytes of a feed come from.
class FeedInput {
 public:
  enum class State { kData, kPause, kEnd };

  virtual ~FeedInput() = default;
  /// Waits up to `timeout_ms` and reads up to `capacity` bytes: some came, none did, or the sender has ended.
  virtual State Read(std::uint8_t* out, std::size_t capacity, int timeout_ms, std::size_t* n) = 0;
  virtual std::string name() const = 0;  // for messages
};

/// Standard input, to its end.
std::unique_ptr<FeedInput> OpenStandardInput();
/// One driver that connects to this port of this host, until it closes the connection. Throws
/// std::runtime_error where the port is taken.
std::unique_ptr<FeedInput> ListenTcp(int port);
/// Datagrams to this port of this host, of whole records each. Has no end.
std::unique_ptr<FeedInput> ListenUdp(int port);

}  // namespace evit::feed
