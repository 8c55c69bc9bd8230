#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace evit {

/// A message bus as the services see it: raw bytes on named channels. Three kinds: live UDP (lcm_bus.h),
/// in memory (memory_bus.h: deterministic, for tests) and a log file as sink or source (log_bus.h).
/// One thread: handlers run inside Poll(), never in between.
class Bus {
 public:
  using Handler = std::function<void(const std::string& channel, const std::uint8_t* data, std::size_t size)>;

  virtual ~Bus() = default;

  /// Sends one message. Errors (no route, message too large) are counted and reported by send_errors().
  virtual void Publish(const std::string& channel, const void* data, std::size_t size) = 0;

  /// Calls `handler` for each message on exactly this channel (no regular expression).
  virtual void Subscribe(const std::string& channel, Handler handler) = 0;

  /// Waits up to `timeout_ms` for messages and hands out all that are there. Returns the number handled.
  virtual int Poll(int timeout_ms) = 0;

  /// Receive buffer that the kernel granted, bytes; 0 where it does not apply.
  virtual int granted_receive_buffer() const { return 0; }
  virtual std::int64_t send_errors() const { return 0; }
  /// Messages thrown away because this process was too slow to take them (a bound on memory, not the kernel's
  /// loss).
  virtual std::int64_t queue_drops() const { return 0; }
};

}  // namespace evit
