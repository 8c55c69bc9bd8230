#include "services/window_optimizer/map_client.h"

#include "common/wire/map_wire.h"

namespace evit {
namespace {

// Real time: how long to wait for one answer, and after which silence map_server counts as dead, so that no
// keyframe waits for it any more. The tracker continues with the points it has.
constexpr RequestClient<MapPointsRequest>::Patience kPatience{std::chrono::milliseconds(20),
                                                              std::chrono::milliseconds(60)};

}  // namespace

MapClient::MapClient(Bus* bus, const Channels& channels, StatusReporter* status, Clock::time_point now)
    : status_(status), requests_(bus, channels, status, kPatience, now) {}

void MapClient::Ask(const MapTracker& tracker, const VisibilityQuery& query, Clock::time_point now) {
  map_query_t message = ToMessage(query);
  message.utime = tracker.state_time();
  asked_ = query;
  requests_.Ask(message, now);
}

void MapClient::AskAhead(const MapTracker& tracker, const KeyframeInput& keyframe, Clock::time_point now) {
  if (answered() && served_ && tracker.Suffices(*served_, tracker.QueryAfter(keyframe))) {
    ++status_->Counter("MAP_QUERY.spared");
  } else {
    Ask(tracker, tracker.QueryBeyond(keyframe), now);
  }
}

void MapClient::Serve(MapTracker* tracker) {
  const std::optional<map_points_t> answer = requests_.TakeAnswer();
  if (!answer) return;
  if (map_id_ && *map_id_ != answer->map_id) {
    tracker->ForgetPoints();
    ++status_->Counter("MAP_POINTS.new_map");
  }
  map_id_ = answer->map_id;
  tracker->AddVisible(answer->id, PointsOf(*answer));
  served_ = asked_;
}

}  // namespace evit
