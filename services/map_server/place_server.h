#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/map/map_index.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "evit/place_query_t.hpp"
#include "evit/places_t.hpp"
#include "services/map_server/place_worker.h"

namespace evit {

/// The part of map_server that says where in the map a keyframe may have been seen from: PLACE_QUERY in,
/// PLACES out. A PlaceWorker finds the answers, one at a time, so that MAP_QUERY does not wait; it
/// costs nothing unless asked. The index of places is made at the first question, or ahead of it with
/// Prepare(). As stateless as the rest: an answer depends on map and question alone.
class PlaceServer {
 public:
  /// `bus`, `status`, which it counts in, and `map` must outlive this.
  PlaceServer(Bus* bus, const Channels& channels, StatusReporter* status, const MapIndex* map);

  /// Begins to make the index, or to read it.
  void Prepare();
  /// Where the index is kept (PlaceIndexPaths). Before Prepare() and the first Tick().
  void KeepIn(const std::vector<std::string>& paths) { worker_.KeepIn(paths); }
  /// Sends what is answered and begins with what is asked; if questions back up, the newest only.
  void Tick();
  bool busy() const { return worker_.busy(); }

 private:
  void OnQuery(const std::uint8_t* data, std::size_t size);
  void Begin(std::optional<place_query_t> message);
  void Send(places_t answer);

  Bus* bus_;
  std::string channel_;
  StatusReporter* status_;
  SequenceCounter queries_;
  std::optional<place_query_t> waiting_;
  std::pair<std::int64_t, std::int64_t> in_work_{-1, -1},
      answered_{-1, -1};              // epoch and number of a question
  std::vector<std::uint8_t> buffer_;  // the last answer
  std::int64_t seq_ = 0;
  PlaceWorker worker_;
};

}  // namespace evit
