#include "tools/monitor/pipeline_watch.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "common/service/status_reporter.h"
#include "common/wire/geometry_wire.h"
#include "common/wire/map_wire.h"

namespace evit::monitor {
namespace {

constexpr std::size_t kKeyframes = 32;  // kept until their estimate comes, as many as frame_builder holds
constexpr std::int64_t kPatienceUs = 300'000;  // without estimates for so long, keyframes are shown without
constexpr std::int64_t kPicturePeriodUs = 30'000;
constexpr std::size_t kOverlayPoints = 4000;
constexpr std::size_t kMostServices = 32;

}  // namespace

template <typename Message>
void PipelineWatch::Listen(Bus* bus, const std::string& channel, void (PipelineWatch::*take)(Message&)) {
  bus->Subscribe(channel, [this, take](const std::string& name, const std::uint8_t* data, std::size_t size) {
    Message message;
    if (!DecodeChecked(data, size, &message)) {
      channels_.CountInvalid(name);
      return;
    }
    std::string sender;
    if constexpr (std::is_same_v<Message, service_status_t>) sender = message.service;
    channels_.CountValid(name, sender, message.epoch, message.seq);
    (this->*take)(message);
  });
}

PipelineWatch::PipelineWatch(Bus* bus, const Channels& channels) {
  Listen(bus, channels.body_pose, &PipelineWatch::TakePose);
  Listen(bus, channels.ground_truth, &PipelineWatch::TakeTruth);
  Listen(bus, channels.tracker_mode, &PipelineWatch::TakeMode);
  Listen(bus, channels.status, &PipelineWatch::TakeStatus);
  Listen(bus, channels.imu, &PipelineWatch::TakeImu);
  Listen(bus, channels.window_state, &PipelineWatch::TakeWindow);
  Listen(bus, channels.keyframe, &PipelineWatch::TakeKeyframe);
  Listen(bus, channels.map_query, &PipelineWatch::TakeQuery);
  Listen(bus, channels.map_points, &PipelineWatch::TakeAnswer);
  Listen(bus, channels.places, &PipelineWatch::TakePlaces);
}

void PipelineWatch::TakePose(body_pose_t& pose) {
  for (PipelineListener* listener : listeners_) listener->OnPose(pose);
}

void PipelineWatch::TakeTruth(body_pose_t& pose) {
  for (PipelineListener* listener : listeners_) listener->OnTruth(pose);
}

void PipelineWatch::TakeMode(tracker_mode_t& mode) {
  mode_ = std::move(mode);
  for (PipelineListener* listener : listeners_) listener->OnMode(mode_);
}

void PipelineWatch::TakeStatus(service_status_t& status) {
  if (services_.size() >= kMostServices && services_.count(status.service) == 0) return;
  for (PipelineListener* listener : listeners_) listener->OnStatus(status);
  const std::string name = status.service;
  services_[name] = {std::move(status), HostTime()};
}

void PipelineWatch::TakeImu(imu_batch_t& batch) {
  if (batch.n > 0) latency_.AddData(batch.sample_utime.back(), HostTime());
}

void PipelineWatch::TakeQuery(map_query_t& query) {
  mount_.AddQuery(query.utime, FromMessage(query).camera, PoseOf(query));
}

void PipelineWatch::TakeAnswer(map_points_t& answer) {
  map_.Add(answer);
  if (AnybodyWantsPicture()) visible_ = PointsOf(answer);
}

void PipelineWatch::TakePlaces(places_t& places) {
  for (PipelineListener* listener : listeners_) listener->OnPlaces(places);
}

bool PipelineWatch::AnybodyWantsPicture() const {
  return std::any_of(listeners_.begin(), listeners_.end(),
                     [](const PipelineListener* listener) { return listener->WantsPicture(); });
}

void PipelineWatch::Show(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points) {
  shown_ = HostTime();
  for (PipelineListener* listener : listeners_) {
    if (listener->WantsPicture()) listener->OnPicture(keyframe, points);
  }
}

void PipelineWatch::TakeKeyframe(keyframe_t& keyframe) {
  const std::int64_t now = HostTime();
  if (now - shown_ < kPicturePeriodUs || !AnybodyWantsPicture()) return;
  if (now - window_heard_ > kPatienceUs) {
    keyframes_.clear();
    Show(keyframe, {});
    return;
  }
  keyframes_.push_back(std::move(keyframe));
  if (keyframes_.size() > kKeyframes) keyframes_.pop_front();
}

std::vector<OverlayPoint> PipelineWatch::Overlay(const keyframe_t& keyframe,
                                                 const window_state_t& window) const {
  if (!mount_.camera() || !mount_.T_body_camera() || keyframe.encoding != keyframe_t::TIME_SURFACE) return {};
  const SE3 T_map_camera = PoseOf(window.node.back()) * *mount_.T_body_camera();
  return ProjectOnto(keyframe, *mount_.camera(), T_map_camera, visible_, kOverlayPoints);
}

void PipelineWatch::TakeWindow(window_state_t& window) {
  const std::int64_t now = HostTime();
  window_heard_ = now;
  if (window.node.empty()) return;
  if (window.mode != tracker_mode_t::LOST) {
    mount_.AddEstimate(window.utime, PoseOf(window.node.back()));
  }
  const double latency_ms = latency_.MsSince(window.utime, now);
  for (PipelineListener* listener : listeners_) listener->OnWindow(window, latency_ms);
  const auto keyframe = std::find_if(keyframes_.begin(), keyframes_.end(),
                                     [&](const keyframe_t& kept) { return kept.utime == window.utime; });
  if (keyframe == keyframes_.end()) return;
  Show(*keyframe, Overlay(*keyframe, window));
  keyframes_.erase(keyframes_.begin(), keyframe + 1);
}

}  // namespace evit::monitor
