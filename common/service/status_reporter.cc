#include "common/service/status_reporter.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/bus/codec.h"

namespace evit {

namespace {

constexpr std::chrono::seconds kPeriod(1);

}  // namespace

StatusReporter::StatusReporter(Bus* bus, const Channels& channels, std::string service, std::int64_t epoch,
                               Clock clock)
    : bus_(bus), channel_(channels.status), clock_(std::move(clock)), message_() {
  message_.service = std::move(service);
  message_.state = "starting";
  message_.epoch = epoch;
  message_.seq = 0;
  message_.progress = -1;
}

void StatusReporter::SetState(const std::string& state, const std::string& detail) {
  const bool changed = state != message_.state;
  message_.state = state;
  message_.detail = detail;
  if (echo_) Echo();
  if (changed) Publish();
}

// What follows the first colon changes all the time (positions, contrasts) and is left out of the comparison.
void StatusReporter::Echo() {
  const std::string head = message_.state + ": " + message_.detail.substr(0, message_.detail.find(':'));
  if (head == echoed_) return;
  echoed_ = head;
  std::fprintf(stderr, "%s: %s: %s\n", message_.service.c_str(), message_.state.c_str(),
               message_.detail.c_str());
}

void StatusReporter::UpdateLosses() {
  if (clock_() - losses_updated_ < kPeriod) return;
  losses_updated_ = clock_();
  const bool before = !losses_.text().empty();
  losses_.Update(counters_);
  if (!echo_ || before == !losses_.text().empty()) return;
  std::fprintf(stderr, "%s: %s\n", message_.service.c_str(),
               before ? "nothing gets lost any more" : losses_.text().c_str());
}

void StatusReporter::SetProgress(double share) {
  message_.progress = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : -1.0;
}

std::int64_t& StatusReporter::Counter(const std::string& name) { return counters_[name]; }

void StatusReporter::AddTiming(const std::string& stage, double milliseconds) {
  Timing& timing = timings_[stage];
  timing.sum_ms += milliseconds;
  ++timing.calls;
}

void StatusReporter::Tick() {
  if (clock_() - last_sent_ >= kPeriod) Publish();
}

void StatusReporter::Publish() {
  message_.utime = HostTime();
  message_.granted_receive_buffer = bus_->granted_receive_buffer();
  counters_["bus.send_errors"] = bus_->send_errors();
  counters_["bus.queue_drops"] = bus_->queue_drops();
  message_.counter_name.clear();
  message_.counter_value.clear();
  for (const auto& [name, value] : counters_) {
    message_.counter_name.push_back(name);
    message_.counter_value.push_back(value);
  }
  message_.n_counters = static_cast<std::int32_t>(message_.counter_name.size());
  message_.timing_name.clear();
  message_.timing_ms.clear();
  for (const auto& [name, timing] : timings_) {
    message_.timing_name.push_back(name);
    message_.timing_ms.push_back(timing.sum_ms / static_cast<double>(timing.calls));
  }
  message_.n_timings = static_cast<std::int32_t>(message_.timing_name.size());
  UpdateLosses();
  const std::string state = message_.state, detail = message_.detail;
  if (!losses_.text().empty() && state == "running") {
    message_.state = "degraded";
    message_.detail += "; " + losses_.text();
  }
  std::vector<std::uint8_t> buffer;
  EncodeTo(message_, &buffer);
  message_.state = state;
  message_.detail = detail;
  bus_->Publish(channel_, buffer.data(), buffer.size());
  ++message_.seq;
  last_sent_ = clock_();
}

std::int64_t NewEpoch() {
  // Microseconds since 1970 tell runs of one service apart; the process id tells apart services that start
  // together.
  static std::int64_t last = 0;
  std::int64_t epoch = HostTime() * 1024 + ::getpid() % 1024;
  if (epoch <= last) epoch = last + 1;
  last = epoch;
  return epoch;
}

std::int64_t HostTime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace evit
