#include "tools/monitor/order_desk.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "common/service/status_reporter.h"
#include "common/wire/geometry_wire.h"

namespace evit::monitor {
namespace {

constexpr Utime kArrived = 500'000;  // us: a tracker this far behind the place sought is there

std::optional<std::int64_t> Counter(const service_status_t& status, const char* name) {
  const auto found = std::find(status.counter_name.begin(), status.counter_name.end(), name);
  if (found == status.counter_name.end()) return std::nullopt;
  return status.counter_value[static_cast<std::size_t>(found - status.counter_name.begin())];
}

// A service that was heard once and is silent now takes no orders. One that was never heard may have no
// STATUS.
void RefuseIfSilent(const PipelineWatch& watch, const std::string& name) {
  constexpr double kSilentS = 5;  // they send STATUS once a second
  const auto service = watch.services().find(name);
  if (service == watch.services().end()) return;
  const double silence = 1e-6 * static_cast<double>(HostTime() - service->second.heard);
  if (silence < kSilentS) return;
  char text[160];
  std::snprintf(text, sizeof text, "%s has not been heard for %.0f s: nobody takes this order", name.c_str(),
                silence);
  throw std::runtime_error(text);
}

std::string SpeedText(double speed) {
  char text[64];
  std::snprintf(text, sizeof text, "replay at %g times real time", speed);
  return text;
}

}  // namespace

OrderDesk::OrderDesk(Bus* bus, const Channels& channels, PipelineWatch* watch, procman::Sheriff* sheriff)
    : watch_(watch),
      sheriff_(sheriff),
      controls_(bus, channels.replay_control, NewEpoch()),
      hints_(bus, channels.pose_hint, NewEpoch()) {
  watch->AddListener(&known_);
  watch->AddListener(this);
}

void OrderDesk::Control(std::int8_t command, std::int64_t seek_utime, double speed) {
  if (watch_->services().count("log_replay") == 0) {
    throw std::runtime_error("no log_replay has been heard: data come from elsewhere");
  }
  RefuseIfSilent(*watch_, "log_replay");
  replay_control_t order{};
  order.utime = HostTime();
  order.command = command;
  order.seek_utime = seek_utime;
  order.speed = speed;
  controls_.Send(&order);
}

std::string OrderDesk::Seek(double share) {
  const auto replay = watch_->services().find("log_replay");
  if (replay == watch_->services().end()) {
    throw std::runtime_error("no log_replay has been heard: data come from elsewhere");
  }
  const auto begin = Counter(replay->second.status, "recording.begin_utime");
  const auto end = Counter(replay->second.status, "recording.end_utime");
  if (!begin || !end || *end < *begin) {
    throw std::runtime_error("log_replay does not say what time its recording spans");
  }
  const auto length = static_cast<double>(*end - *begin);
  const Utime t = *begin + static_cast<std::int64_t>(share * length);
  Control(replay_control_t::SEEK, t, 1);
  const std::optional<SE3> pose = t == *begin && start_ ? start_ : known_.At(t);
  sought_.reset();
  if (pose) {
    Hint(*pose);
    sought_ = {t, *pose};
  }
  char text[128];
  std::snprintf(text, sizeof text, "replay goes to %.2f s%s", 1e-6 * share * length,
                pose ? ", the tracker to where the body was then"
                     : "; where the body was then is not known: give a pose, or let it be looked for");
  return text;
}

void OrderDesk::Hint(const SE3& T_map_body) {
  body_pose_t hint{};
  hint.utime = HostTime();
  PutPose(T_map_body, &hint);
  hints_.Send(&hint);
}

// Keyframes from before the jump may have come after the first hint, and moved the tracker away from it.
void OrderDesk::OnMode(const tracker_mode_t& mode) {
  if (!sought_ || mode.utime < sought_->t || mode.utime > sought_->t + kArrived) return;
  if (mode.mode != tracker_mode_t::TRACKING) Hint(sought_->T_map_body);
  sought_.reset();
}

std::string OrderDesk::Give(const PageOrder& order) {
  switch (order.kind) {
    case PageOrder::Kind::kAcknowledge:
      return "";
    case PageOrder::Kind::kRestart:
      sheriff_->Begin(procman::Sheriff::Order::kRestart, order.command);
      return order.command + " is being restarted";
    case PageOrder::Kind::kPause:
      Control(replay_control_t::PAUSE, 0, 1);
      return "replay paused";
    case PageOrder::Kind::kResume:
      Control(replay_control_t::RESUME, 0, 1);
      return "replay continues";
    case PageOrder::Kind::kSeek:
      return Seek(order.seek_share);
    case PageOrder::Kind::kSpeed:
      Control(replay_control_t::SPEED, 0, order.speed);
      return SpeedText(order.speed);
    case PageOrder::Kind::kHint:
      break;
  }
  RefuseIfSilent(*watch_, "window_optimizer");
  sought_.reset();  // this one counts
  Hint(order.T_map_body);
  return "pose sent to the tracker";
}

}  // namespace evit::monitor
