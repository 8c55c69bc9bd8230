#include "tools/monitor/foxglove_audience.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/service/status_reporter.h"
#include "common/wire/geometry_wire.h"

namespace evit::monitor {
namespace {

using nlohmann::json;

constexpr std::uint8_t kMessageData = 1;  // opcode
constexpr std::int64_t kPosePeriodUs = 15'000;
constexpr std::int64_t kSurfacePeriodUs = 90'000;  // no acknowledgement tells what the viewer can draw
constexpr std::int64_t kMapPeriodUs = 2'000'000;
constexpr std::size_t kMostSubscriptions = 64;

}  // namespace

FoxgloveAudience::FoxgloveAudience(std::function<void(ClientId)> wake)
    : wake_(std::move(wake)), session_(std::to_string(NewEpoch())) {}

void FoxgloveAudience::Connected(ClientId client, const std::string& /*protocol*/) {
  Viewer& viewer = viewers_[client];
  viewer.queue.Append(TextFrame(FoxgloveServerInfo(session_)));
  viewer.queue.Append(TextFrame(FoxgloveAdvertisement()));
  wake_(client);
}

void FoxgloveAudience::Subscribe(Viewer* viewer, std::uint32_t subscription, std::uint32_t channel) {
  if (channel < static_cast<std::uint32_t>(FoxgloveChannel::kPose) ||
      channel > static_cast<std::uint32_t>(FoxgloveChannel::kLog) ||
      viewer->subscriptions.size() >= kMostSubscriptions) {
    return;
  }
  viewer->subscriptions[static_cast<FoxgloveChannel>(channel)] = subscription;
  // What does not change is said again for whoever has just come.
  map_sent_ = 0;
  map_time_ = 0;
  mode_.clear();
  states_.clear();
}

void FoxgloveAudience::Received(ClientId client, std::string_view message) {
  Viewer& viewer = viewers_.at(client);
  const json order = json::parse(message.begin(), message.end(), nullptr, false);
  const auto text = [](const json& object, const char* name) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    return object.is_object() && found != object.end() && found->is_string() ? found->get<std::string>() : "";
  };
  const std::string op = text(order, "op");
  if (op == "subscribe" && order.contains("subscriptions") && order["subscriptions"].is_array()) {
    for (const json& s : order["subscriptions"]) {
      if (!s.is_object() || !s.contains("id") || !s.contains("channelId")) continue;
      if (!s["id"].is_number_unsigned() || !s["channelId"].is_number_unsigned()) continue;
      Subscribe(&viewer, s["id"].get<std::uint32_t>(), s["channelId"].get<std::uint32_t>());
    }
  } else if (op == "unsubscribe" && order.contains("subscriptionIds") &&
             order["subscriptionIds"].is_array()) {
    for (const json& id : order["subscriptionIds"]) {
      for (auto s = viewer.subscriptions.begin(); s != viewer.subscriptions.end();) {
        s = id.is_number_unsigned() && s->second == id.get<std::uint32_t>() ? viewer.subscriptions.erase(s)
                                                                            : std::next(s);
      }
    }
  } else {
    viewer.queue.Replace("status", TextFrame(R"({"op":"status","level":1,"message":"not supported here"})"));
    wake_(client);
  }
}

bool FoxgloveAudience::Subscribed(FoxgloveChannel channel) const {
  return std::any_of(viewers_.begin(), viewers_.end(), [channel](const auto& viewer) {
    return viewer.second.subscriptions.count(channel) > 0;
  });
}

void FoxgloveAudience::Send(FoxgloveChannel channel, const std::string& name, std::int64_t utime,
                            const google::protobuf::MessageLite& message) {
  const std::string payload = message.SerializeAsString();
  for (auto& [client, viewer] : viewers_) {
    const auto subscription = viewer.subscriptions.find(channel);
    if (subscription == viewer.subscriptions.end()) continue;
    auto frame = std::make_shared<Frame>(false);
    frame->Reserve(13 + payload.size());
    frame->Append(kMessageData);
    frame->Append(subscription->second);
    frame->Append(static_cast<std::uint64_t>(std::max<std::int64_t>(0, utime)) * 1000);
    frame->Append(payload.data(), payload.size());
    viewer.queue.Replace(name, frame);
    wake_(client);
  }
}

void FoxgloveAudience::Tick() {
  const std::int64_t now = HostTime();
  if (map_ == nullptr || now - map_time_ < kMapPeriodUs || map_->points().size() == map_sent_) return;
  if (!Subscribed(FoxgloveChannel::kMap)) return;
  map_time_ = now;
  map_sent_ = map_->points().size();
  Send(FoxgloveChannel::kMap, "map", now, ToFoxgloveMap(now, *map_));
}

void FoxgloveAudience::OnPose(const body_pose_t& pose) {
  const std::int64_t now = HostTime();
  if (viewers_.empty() || now - pose_time_ < kPosePeriodUs) return;
  pose_time_ = now;
  Send(FoxgloveChannel::kPose, "pose", pose.utime, ToFoxglovePose(pose.utime, PoseOf(pose)));
  Send(FoxgloveChannel::kTransform, "tf", pose.utime, ToFoxgloveTransform(pose.utime, PoseOf(pose)));
}

void FoxgloveAudience::OnTruth(const body_pose_t& pose) {
  if (Subscribed(FoxgloveChannel::kTruth)) {
    Send(FoxgloveChannel::kTruth, "truth", pose.utime, ToFoxglovePose(pose.utime, PoseOf(pose)));
  }
}

void FoxgloveAudience::OnMode(const tracker_mode_t& mode) {
  const std::string told = std::to_string(mode.mode) + mode.reason;
  if (told == mode_ || !Subscribed(FoxgloveChannel::kLog)) return;
  mode_ = told;
  Send(FoxgloveChannel::kLog, "log tracker", mode.utime, ToFoxgloveLog(mode.utime, mode));
}

void FoxgloveAudience::OnStatus(const service_status_t& status) {
  std::string& told = states_[status.service];
  if (told == status.state + status.detail || !Subscribed(FoxgloveChannel::kLog)) return;
  told = status.state + status.detail;
  Send(FoxgloveChannel::kLog, "log " + status.service, status.utime, ToFoxgloveLog(status.utime, status));
}

void FoxgloveAudience::OnPicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& /*points*/) {
  const std::int64_t now = HostTime();
  if (now - surface_time_ < kSurfacePeriodUs) return;
  surface_time_ = now;
  Send(FoxgloveChannel::kSurface, "surface", keyframe.utime, ToFoxgloveImage(keyframe));
}

}  // namespace evit::monitor
