#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "tools/monitor/foxglove_channels.h"
#include "tools/monitor/pipeline_watch.h"
#include "tools/monitor/viewer_queue.h"
#include "tools/monitor/web_server.h"

namespace evit::monitor {

/// Viewers that speak the Foxglove WebSocket protocol (foxglove.websocket.v1): Foxglove, Lichtblick. They see
/// pose, map, time surface and diagnostics, and give no orders. Of each channel only the newest message
/// waits.
class FoxgloveAudience : public WebClients, public PipelineListener {
 public:
  static constexpr char kProtocol[] = "foxglove.websocket.v1";

  explicit FoxgloveAudience(std::function<void(ClientId)> wake);

  /// null: none. It must outlive this.
  void SetMap(const MapStore* map) { map_ = map; }
  /// Call often: sends the map again where it has grown.
  void Tick();

  void Connected(ClientId client, const std::string& protocol) override;
  void Closed(ClientId client) override { viewers_.erase(client); }
  void Received(ClientId client, std::string_view message) override;
  FramePtr Next(ClientId client) override { return viewers_.at(client).queue.Next(); }

  void OnPose(const body_pose_t& pose) override;
  void OnTruth(const body_pose_t& pose) override;
  void OnMode(const tracker_mode_t& mode) override;
  void OnStatus(const service_status_t& status) override;
  void OnPicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points) override;
  bool WantsPicture() const override { return Subscribed(FoxgloveChannel::kSurface); }

 private:
  struct Viewer {
    ViewerQueue queue;
    std::map<FoxgloveChannel, std::uint32_t> subscriptions;  // the viewer's number for it
  };
  bool Subscribed(FoxgloveChannel channel) const;
  void Subscribe(Viewer* viewer, std::uint32_t subscription, std::uint32_t channel);
  /// To all that have subscribed, under `name`: takes the place of what waits under the same.
  void Send(FoxgloveChannel channel, const std::string& name, std::int64_t utime,
            const google::protobuf::MessageLite& message);

  std::function<void(ClientId)> wake_;
  std::string session_;
  std::map<ClientId, Viewer> viewers_;
  const MapStore* map_ = nullptr;
  std::size_t map_sent_ = 0;                                      // points
  std::int64_t map_time_ = 0, pose_time_ = 0, surface_time_ = 0;  // us, host clock: last sent
  std::string mode_;                                              // last told
  std::map<std::string, std::string> states_;                     // last told, by service
};

}  // namespace evit::monitor
