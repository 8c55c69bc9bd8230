#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "evit/messages.hpp"
#include "tools/monitor/camera_mount.h"
#include "tools/monitor/channel_watch.h"
#include "tools/monitor/latency_meter.h"
#include "tools/monitor/map_store.h"
#include "tools/monitor/surface_overlay.h"

namespace evit::monitor {

/// Hears of what a PipelineWatch sees. All that comes has been checked.
class PipelineListener {
 public:
  virtual ~PipelineListener() = default;
  virtual void OnPose(const body_pose_t& /*pose*/) {}
  virtual void OnTruth(const body_pose_t& /*pose*/) {}
  virtual void OnMode(const tracker_mode_t& /*mode*/) {}
  /// Where the body may be, as map_server answers a tracker that does not know.
  virtual void OnPlaces(const places_t& /*places*/) {}
  virtual void OnStatus(const service_status_t& /*status*/) {}
  /// `latency_ms`: from the instant it stands for until now; negative: not known.
  virtual void OnWindow(const window_state_t& /*window*/, double /*latency_ms*/) {}
  /// A keyframe, with the map points as the estimate for it projects them; none where there is no estimate.
  virtual void OnPicture(const keyframe_t& /*keyframe*/, const std::vector<OverlayPoint>& /*points*/) {}
  /// Whether OnPicture is worth its while now.
  virtual bool WantsPicture() const { return false; }
};

/// Listens to a pipeline on the bus and keeps what is newest. Sends nothing.
class PipelineWatch {
 public:
  /// `bus` must outlive this.
  PipelineWatch(Bus* bus, const Channels& channels);

  /// `listener` must outlive this.
  void AddListener(PipelineListener* listener) { listeners_.push_back(listener); }
  CameraMount* mount() { return &mount_; }
  const CameraMount& mount() const { return mount_; }
  MapStore* map() { return &map_; }
  const MapStore& map() const { return map_; }
  const LatencyMeter& latency() const { return latency_; }

  /// Call about once a second.
  void UpdateRates() { channels_.UpdateRates(ChannelWatch::Clock::now()); }
  const ChannelWatch& channels() const { return channels_; }

  struct Service {
    service_status_t status;
    std::int64_t heard = 0;  // us, host clock
  };
  /// The newest STATUS of each service, by name.
  const std::map<std::string, Service>& services() const { return services_; }
  const tracker_mode_t& mode() const { return mode_; }
  /// A message of the tracker has been heard.
  bool has_mode() const { return !mode_.reason.empty(); }

 private:
  template <typename Message>
  void Listen(Bus* bus, const std::string& channel, void (PipelineWatch::*take)(Message&));
  void TakePose(body_pose_t& pose);
  void TakeTruth(body_pose_t& pose);
  void TakeMode(tracker_mode_t& mode);
  void TakeStatus(service_status_t& status);
  void TakeImu(imu_batch_t& batch);
  void TakeWindow(window_state_t& window);
  void TakeKeyframe(keyframe_t& keyframe);
  void TakeQuery(map_query_t& query);
  void TakeAnswer(map_points_t& answer);
  void TakePlaces(places_t& places);
  bool AnybodyWantsPicture() const;
  void Show(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points);
  std::vector<OverlayPoint> Overlay(const keyframe_t& keyframe, const window_state_t& window) const;

  std::vector<PipelineListener*> listeners_;
  ChannelWatch channels_;
  LatencyMeter latency_;
  CameraMount mount_;
  MapStore map_;
  std::map<std::string, Service> services_;
  tracker_mode_t mode_{};
  std::deque<keyframe_t> keyframes_;      // that wait for their estimate
  std::vector<Eigen::Vector3f> visible_;  // map_server's newest answer
  std::int64_t window_heard_ = 0;         // us, host clock
  std::int64_t shown_ = 0;                // us, host clock: the last picture
};

}  // namespace evit::monitor
