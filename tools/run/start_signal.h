#pragma once

#include <chrono>

#include "tools/run/recorder.h"
#include "tools/run/remote.h"

namespace evit::run {

/// Tells log_replay to begin once all services are there, and again until it obeys: UDP may lose an order.
/// Once it has begun, a pause is somebody's wish, and holds.
class StartSignal {
 public:
  /// `remote` must outlive this.
  explicit StartSignal(Remote* remote) : remote_(remote) {}

  /// Call often.
  void Tick(const Recorder& recorder);
  /// log_replay has played since the first order.
  bool begun() const { return begun_; }

 private:
  using Clock = std::chrono::steady_clock;

  Remote* remote_;
  bool sent_ = false, begun_ = false;
  Clock::time_point sent_at_;
};

}  // namespace evit::run
