#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/service/loss_watch.h"
#include "evit/service_status_t.hpp"

namespace evit {

/// Collects a service's health and sends it as STATUS: at 1 Hz, and at once when the state changes. While
/// messages are lost, "running" is sent as "degraded", and the detail says on which channels.
class StatusReporter {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;

  /// `bus` must outlive this. `clock`: tests have their own.
  StatusReporter(Bus* bus, const Channels& channels, std::string service, std::int64_t epoch,
                 Clock clock = std::chrono::steady_clock::now);

  /// `state`: one word, see service_status_t. `detail`: for a person.
  void SetState(const std::string& state, const std::string& detail);
  void SetProgress(double share);  // 0..1
  /// Every reporter of this process also writes changes of state to stderr (a service's log).
  static void EchoToStderr() { echo_ = true; }
  /// A counter by name, created at zero; the reference stays valid.
  std::int64_t& Counter(const std::string& name);
  /// One call of a stage took this long; STATUS shows the mean.
  void AddTiming(const std::string& stage, double milliseconds);

  void Tick();     // call often: sends when a second has passed
  void Publish();  // sends now

  const std::string& state() const { return message_.state; }
  std::int64_t epoch() const { return message_.epoch; }

 private:
  void Echo();
  void UpdateLosses();

  static inline bool echo_ = false;
  struct Timing {
    double sum_ms = 0;
    std::int64_t calls = 0;
  };
  Bus* bus_;
  std::string channel_;
  Clock clock_;
  service_status_t message_;
  std::map<std::string, std::int64_t> counters_;
  std::map<std::string, Timing> timings_;
  std::chrono::steady_clock::time_point last_sent_;
  LossWatch losses_;
  std::chrono::steady_clock::time_point losses_updated_;
  std::string echoed_;
};

/// An epoch for a new run of a service: different at each start.
std::int64_t NewEpoch();

/// Host clock in us, for stamps of STATUS and the like.
std::int64_t HostTime();

}  // namespace evit
