#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/map/map_index.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "evit/map_query_t.hpp"
#include "services/map_server/place_server.h"
#include "services/map_server/view_server.h"

namespace evit {

/// MAP_QUERY in, MAP_POINTS out; PLACE_QUERY in, PLACES out. Keeps no state but the map: an answer depends on
/// the query alone, so it can be restarted at any moment, and the same query gets the same points.
class MapServer : public Service {
 public:
  /// `bus` must outlive this. `description`: what STATUS says of the map.
  MapServer(Bus* bus, const Channels& channels, MapIndex index, const std::string& description);

  /// Draws views of this map too: VIEW_QUERY in, MAP_VIEW out.
  void ServeViews(const PhotometricMap& map) { views_.emplace(bus_, channels_, &status_, map); }

  /// The index of places for PLACE_QUERY is kept in one of these files from one run to the next.
  void KeepPlacesIn(const std::vector<std::string>& paths) { places_.KeepIn(paths); }
  /// Builds the index of places now instead of at the first PLACE_QUERY.
  void PreparePlaces() { places_.Prepare(); }

  /// Answers what has come in since the last call, in order; if queries back up, the newest only.
  void Tick() override;
  void Stop() override { status_.SetState("finished", "stopped"); }

 private:
  void OnQuery(const std::uint8_t* data, std::size_t size);
  void Answer(const map_query_t& message);

  Bus* bus_;
  Channels channels_;
  MapIndex index_;
  std::int64_t map_id_;
  StatusReporter status_;
  SequenceCounter queries_;
  std::int64_t* dropped_;  // counter of STATUS
  std::deque<map_query_t> queue_;
  std::int64_t seq_ = 0;
  std::vector<std::uint8_t> buffer_;
  std::optional<ViewServer> views_;
  PlaceServer places_;
};

}  // namespace evit
