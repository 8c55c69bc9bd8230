#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/service/status_reporter.h"
#include "common/tracking/map_tracker.h"
#include "services/window_optimizer/request_client.h"

namespace evit {

/// Asks map_server for the points that a tracker needs, and hands them to it. A query that the points at hand
/// serve as well is spared, and counted as MAP_QUERY.spared in STATUS.
class MapClient {
 public:
  using Clock = RequestClient<MapPointsRequest>::Clock;

  /// `bus` and `status` must outlive this.
  MapClient(Bus* bus, const Channels& channels, StatusReporter* status, Clock::time_point now);

  /// Asks for the view that `tracker` will look at next.
  void Ask(const MapTracker& tracker, Clock::time_point now) { Ask(tracker, tracker.NextQuery(), now); }
  /// The same for the keyframe after this one, which is about to be processed, where that needs other points.
  void AskAhead(const MapTracker& tracker, const KeyframeInput& keyframe, Clock::time_point now);
  /// Hands the answer over, where there is one that has not been. If it is of another map than the answer
  /// before, as of a map_server that was restarted with another file, the tracker first forgets the points it
  /// has: counted as MAP_POINTS.new_map.
  void Serve(MapTracker* tracker);

  void Tick(Clock::time_point now) { requests_.Tick(now); }
  /// A message of MAP_POINTS. True where it is the answer.
  bool OnAnswer(const std::uint8_t* data, std::size_t size, Clock::time_point now) {
    return requests_.OnAnswer(data, size, now);
  }
  /// Nothing is asked for that has not come.
  bool answered() const { return requests_.answered(); }
  bool GivenUp(Clock::time_point now) const { return requests_.GivenUp(now); }
  bool ServerTimedOut(Clock::time_point now) const { return requests_.ServerTimedOut(now); }

 private:
  void Ask(const MapTracker& tracker, const VisibilityQuery& query, Clock::time_point now);

  StatusReporter* status_;
  RequestClient<MapPointsRequest> requests_;
  std::optional<std::int64_t> map_id_;     // of the newest answer
  VisibilityQuery asked_;                  // the newest
  std::optional<VisibilityQuery> served_;  // the newest whose answer the tracker has
};

}  // namespace evit
