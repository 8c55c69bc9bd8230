#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/photometric/view_renderer.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "evit/view_query_t.hpp"

namespace evit {

/// The part of map_server that holds a photometric map: VIEW_QUERY in, MAP_VIEW out. As stateless as the
/// rest.
class ViewServer {
 public:
  /// `bus` and `status`, which it counts in, must outlive this.
  ViewServer(Bus* bus, const Channels& channels, StatusReporter* status, const PhotometricMap& map);

  /// Answers what has come in since the last call, in order; of a flood the newest queries only.
  void Tick();

 private:
  void OnQuery(const std::uint8_t* data, std::size_t size);
  void Answer(const view_query_t& message);

  Bus* bus_;
  std::string channel_;
  StatusReporter* status_;
  SequenceCounter queries_;
  std::int64_t* dropped_;  // counter of STATUS
  ViewRenderer renderer_;
  std::deque<view_query_t> queue_;
  PhotometricView view_;
  std::int64_t seq_ = 0;
  std::pair<std::int64_t, std::int64_t> answered_{
      -1, -1};  // epoch and number of the query whose answer is in buffer_
  std::vector<std::uint8_t> buffer_;
};

}  // namespace evit
