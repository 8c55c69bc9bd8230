#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/localization/place_index.h"
#include "common/map/map_index.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "evit/place_query_t.hpp"
#include "evit/places_t.hpp"

namespace evit {

/// The part of map_server that says where in the map a keyframe may have been seen from: PLACE_QUERY in,
/// PLACES out. Works in a thread of its own, one question at a time, so that MAP_QUERY does not wait; it
/// costs nothing unless asked. The index of places is made at the first question, or ahead of it with
/// Prepare(). As stateless as the rest: an answer depends on map and question alone.
class PlaceServer {
 public:
  /// `bus`, `status`, which it counts in, and `map` must outlive this.
  PlaceServer(Bus* bus, const Channels& channels, StatusReporter* status, const MapIndex* map);
  ~PlaceServer();

  /// Begins to make the index, or to read it.
  void Prepare();
  /// Where the index is kept (PlaceIndexPath). Before the first Tick().
  void KeepIn(const std::string& path) { path_ = path; }
  /// Sends what is answered and begins with what is asked; if questions back up, the newest only.
  void Tick();
  bool busy() const { return work_.valid(); }

 private:
  void OnQuery(const std::uint8_t* data, std::size_t size);
  std::optional<places_t> Answer(const place_query_t& message);
  void MakeIndex();
  void Begin(std::optional<place_query_t> message);

  Bus* bus_;
  std::string channel_;
  StatusReporter* status_;
  SequenceCounter queries_;
  const MapIndex* map_;
  std::string path_;                         // empty: not kept
  std::unique_ptr<const PlaceIndex> index_;  // the thread's, while it works
  bool index_read_ = false;                  // from its file; the thread's, too
  std::atomic<double> prepared_{0};          // 0..1: of the index
  std::atomic<bool> stopping_{false};
  std::optional<place_query_t> waiting_;
  std::pair<std::int64_t, std::int64_t> in_work_{-1, -1},
      answered_{-1, -1};              // epoch and number of a question
  std::vector<std::uint8_t> buffer_;  // the last answer
  std::int64_t seq_ = 0;
  std::future<std::optional<places_t>> work_;  // last member: the thread ends before anything else is gone
};

}  // namespace evit
