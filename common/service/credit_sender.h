#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "evit/credit_t.hpp"

namespace evit {

/// A clock that never jumps, us, for time-outs.
std::int64_t SteadyTime();

/// A consumer's side of lossless replay: says on CREDIT how far it has come. A credit goes out for each 256
/// kB consumed (less where the receive buffer is small), within 2 ms of anything consumed, every 50 ms, and
/// at the next Tick() after Ask(): so the sender hears of a consumer before it sends anything, a window that
/// holds few messages does not stall, and a lost credit is made good by the next.
class CreditSender {
 public:
  static constexpr std::int64_t kBytes = 256 << 10;  // a quarter of the largest window
  static constexpr std::int64_t kPeriodUs = 50'000;
  static constexpr std::int64_t kBusyPeriodUs = 2'000;

  /// `consumer`: service name, what log_replay has as --wait-for. `epoch`: of this run of the consumer.
  /// `clock`: us, monotonic; tests have their own.
  CreditSender(Bus* bus, const Channels& channels, const std::string& consumer, std::int64_t epoch,
               std::function<std::int64_t()> clock = SteadyTime);

  /// Where the consumer is now: the next message it needs of each stream (-1: does not consume it), of the
  /// streams with this epoch (-1: has heard none yet); `bytes` consumed since the last call. Sends when it is
  /// time to.
  void Consumed(std::int64_t stream_epoch, std::int64_t next_events_seq, std::int64_t next_imu_seq,
                std::size_t bytes);

  /// Something came twice or out of order: the sender should know soon where this consumer is.
  void Ask() { asked_ = true; }

  /// Call often.
  void Tick();

 private:
  void Send();
  std::int64_t BytesPerCredit() const;

  Bus* bus_;
  std::string channel_;
  std::function<std::int64_t()> clock_;
  credit_t message_;
  std::vector<std::uint8_t> buffer_;
  std::int64_t bytes_ = 0;
  std::int64_t last_sent_us_ = 0;  // of the clock
  bool asked_ = true;              // the first Tick says "here I am"
};

}  // namespace evit
