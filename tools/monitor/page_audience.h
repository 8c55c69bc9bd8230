#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "tools/monitor/page_order.h"
#include "tools/monitor/pipeline_watch.h"
#include "tools/monitor/run_history.h"
#include "tools/monitor/viewer_queue.h"
#include "tools/monitor/web_server.h"

namespace evit::monitor {

/// The pages that are open: what the pipeline does goes into a queue for each, their orders to `give`. A page
/// that is opened later, even after the end, gets the last minute and the newest picture.
class PageAudience : public WebClients, public PipelineListener {
 public:
  static constexpr char kProtocol[] = "evit-monitor.v1";
  using Wake = std::function<void(ClientId)>;
  /// Gives an order to the pipeline; what was done, or an exception that says why it was not.
  using Give = std::function<std::string(const PageOrder&)>;

  PageAudience(Wake wake, Give give) : wake_(std::move(wake)), give_(std::move(give)) {}

  /// The map that viewers get, piece by piece, and what says how late pictures are. Both must outlive this.
  void SetPipeline(const MapStore* map, const LatencyMeter* latency) {
    map_ = map;
    latency_ = latency;
  }
  /// To all; who comes later gets the newest.
  void Publish(const std::string& name, const std::string& text);
  int size() const { return static_cast<int>(viewers_.size()); }

  void Connected(ClientId client, const std::string& protocol) override;
  void Closed(ClientId client) override { viewers_.erase(client); }
  void Received(ClientId client, std::string_view message) override;
  FramePtr Next(ClientId client) override;

  void OnPose(const body_pose_t& pose) override;
  void OnTruth(const body_pose_t& pose) override;
  void OnMode(const tracker_mode_t& mode) override;
  void OnPlaces(const places_t& places) override;
  void OnWindow(const window_state_t& window, double latency_ms) override;
  void OnPicture(const keyframe_t& keyframe, const std::vector<OverlayPoint>& points) override;
  bool WantsPicture() const override;

 private:
  struct Viewer {
    ViewerQueue queue;
    std::uint32_t generation = 0;  // of the map it has
    std::size_t map_sent = 0;      // points of it
  };
  void Replace(const std::string& name, const FramePtr& frame);
  FramePtr NextOfMap(Viewer* viewer) const;
  void TakeAcknowledgement(double drawn_utime, Viewer* viewer) const;

  Wake wake_;
  Give give_;
  std::map<ClientId, Viewer> viewers_;
  const MapStore* map_ = nullptr;
  const LatencyMeter* latency_ = nullptr;
  std::map<std::string, FramePtr> newest_;  // by name: what a new viewer gets first, after the history
  RunHistory history_;
  FramePtr picture_;                             // the newest
  std::int64_t pose_sent_ = 0, truth_sent_ = 0;  // us, host clock
  std::int64_t pictured_ = 0;                    // us, host clock
  std::string mode_text_;
};

}  // namespace evit::monitor
