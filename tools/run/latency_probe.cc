#include "tools/run/latency_probe.h"

#include <algorithm>

#include "common/bus/codec.h"
#include "common/time/milliseconds.h"

namespace evit::run {
namespace {

constexpr std::size_t kKept = 4096;  // messages: some seconds

template <typename Message, typename Method>
void On(Bus* bus, const std::string& channel, Method method) {
  bus->Subscribe(channel, [method](const std::string&, const std::uint8_t* data, std::size_t size) {
    Message message;
    if (DecodeChecked(data, size, &message)) method(message);
  });
}

}  // namespace

LatencyProbe::LatencyProbe(Bus* bus, const Channels& channels) {
  On<event_packet_t>(bus, channels.events, [this](const event_packet_t& m) {
    events_.Add(m.utime + (m.n > 0 ? m.dt_us.back() : 0));
  });
  On<imu_batch_t>(bus, channels.imu, [this](const imu_batch_t& m) {
    if (m.n > 0) imu_.Add(m.sample_utime.back());
  });
  On<window_state_t>(bus, channels.window_state, [this](const window_state_t& m) {
    if (m.mode != tracker_mode_t::TRACKING || m.utime <= newest_) return;
    newest_ = m.utime;
    Keep(events_.MsSince(m.utime + m.lookahead_us), &after_events_);
    Keep(events_.MsSince(m.utime), &after_stamp_);
  });
  On<body_pose_t>(bus, channels.body_pose,
                  [this](const body_pose_t& m) { Keep(imu_.MsSince(m.utime), &imu_pose_); });
}

void LatencyProbe::Arrivals::Add(Utime up_to) {
  if (!arrivals_.empty() && up_to <= arrivals_.back().up_to) return;
  arrivals_.push_back({up_to, Clock::now()});
  if (arrivals_.size() > kKept) arrivals_.pop_front();
}

double LatencyProbe::Arrivals::MsSince(Utime t) const {
  const auto found = std::lower_bound(arrivals_.begin(), arrivals_.end(), t,
                                      [](const Arrival& a, Utime time) { return a.up_to < time; });
  if (found == arrivals_.end() || (found == arrivals_.begin() && t < found->up_to)) return -1;
  return Milliseconds(Clock::now() - found->at);
}

void LatencyProbe::Keep(double ms, std::vector<double>* into) {
  if (ms >= 0) into->push_back(ms);
}

LatencyProbe::Summary LatencyProbe::Summarize(std::vector<double> ms) {
  if (ms.empty()) return {};
  std::sort(ms.begin(), ms.end());
  const auto at = [&](double share) {
    return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
  };
  return {static_cast<int>(ms.size()), at(0.5), at(0.99), ms.back()};
}

}  // namespace evit::run
