#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/geometry/rig.h"
#include "common/localization/place_query.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "common/tracking/map_tracker.h"
#include "services/window_optimizer/request_client.h"

namespace evit {

/// Brings a tracker's questions about places (MapTracker::PlaceQuestion) to map_server and the answers back,
/// and what others know of the place (PLACE_PRIOR) to the tracker. A tracker that asks nothing costs nothing.
class PlaceClient {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bus` and `status` must outlive this.
  PlaceClient(Bus* bus, const Channels& channels, StatusReporter* status, const Rig& rig,
              Clock::time_point now);

  /// `tracker` at rest: gives it the answer, where one has come, and asks what it asks now.
  void Serve(MapTracker* tracker, Clock::time_point now);
  /// A message of PLACES. True where it is the answer.
  bool OnAnswer(const std::uint8_t* data, std::size_t size, Clock::time_point now);
  /// Call often: asks again.
  void Tick(Clock::time_point now);
  /// A question has no answer yet.
  bool waiting() const { return asked_ != 0 && !client_.answered(); }

 private:
  void OnPrior(const std::uint8_t* data, std::size_t size);

  RequestClient<PlacesRequest> client_;
  Rig rig_;
  SequenceCounter priors_;
  std::optional<PlacePrior> prior_;  // not told to the tracker yet
  std::int64_t asked_ = 0;           // number of the tracker's question; 0: none
};

}  // namespace evit
