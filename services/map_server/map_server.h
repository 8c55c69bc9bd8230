#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/map/visibility.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"

namespace evit {

/// MAP_QUERY in, MAP_POINTS out. Keeps no state but the map: an answer depends on the query alone, so it can
/// be restarted at any moment, and the same query gets the same points.
class MapServer : public Service {
 public:
  /// `bus` must outlive this. `description`: what STATUS says of the map.
  MapServer(Bus* bus, const Channels& channels, MapIndex index, const std::string& description);

  void Tick() override { status_.Tick(); }
  void Stop() override { status_.SetState("finished", "stopped"); }

 private:
  void OnQuery(const std::uint8_t* data, std::size_t size);

  Bus* bus_;
  Channels channels_;
  MapIndex index_;
  StatusReporter status_;
  SequenceCounter queries_;
  std::int64_t seq_ = 0;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace evit
