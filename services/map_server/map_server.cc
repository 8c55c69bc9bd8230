#include "services/map_server/map_server.h"

#include <chrono>
#include <utility>

#include "common/bus/codec.h"
#include "common/files/content_hash.h"
#include "common/time/milliseconds.h"
#include "common/wire/map_wire.h"

namespace evit {
namespace {

constexpr int kMaxPoints = 20'000;      // in one answer: 320 kB, well within a receive buffer
constexpr std::size_t kMaxQueued = 64;  // queries; more are a flood, and old answers help nobody
constexpr double kMaxMargin = 2000;  // pixels: the depth buffer covers the margin too, its memory is bounded

std::int64_t IdOf(const PointMap& map) {
  ContentHash hash;
  hash.Add(map.points.data(), map.points.size() * sizeof map.points[0]);
  return static_cast<std::int64_t>(hash.value());
}

}  // namespace

MapServer::MapServer(Bus* bus, const Channels& channels, MapIndex index, const std::string& description)
    : bus_(bus),
      channels_(channels),
      index_(std::move(index)),
      map_id_(IdOf(index_.map())),
      status_(bus, channels, "map_server", NewEpoch()),
      queries_(&status_, "MAP_QUERY"),
      dropped_(&status_.Counter("MAP_QUERY.dropped")),
      places_(bus, channels, &status_, &index_) {
  bus_->Subscribe(channels_.map_query, [this](const std::string&, const std::uint8_t* data,
                                              std::size_t size) { OnQuery(data, size); });
  status_.Counter("map.points") = static_cast<std::int64_t>(index_.map().points.size());
  status_.SetState("running", description);
}

void MapServer::OnQuery(const std::uint8_t* data, std::size_t size) {
  map_query_t message;
  Camera::Model model{};
  if (!DecodeChecked(data, size, &message) || !CameraModelFromName(message.camera.model, &model) ||
      message.max_points < 1 || message.max_points > kMaxPoints || message.margin_px > kMaxMargin) {
    queries_.CountInvalid();
    return;
  }
  // A query sent again is answered again: its first answer may have been lost.
  queries_.Commit(message.epoch, message.seq);
  if (queue_.size() == kMaxQueued) {
    queue_.pop_front();
    ++*dropped_;
  }
  queue_.push_back(std::move(message));
}

void MapServer::Tick() {
  for (; !queue_.empty(); queue_.pop_front()) Answer(queue_.front());
  if (views_) views_->Tick();
  places_.Tick();
  status_.Tick();
}

void MapServer::Answer(const map_query_t& message) {
  const auto begin = std::chrono::steady_clock::now();
  const VisibilityAnswer visible = index_.Query(FromMessage(message));
  status_.AddTiming("query", Milliseconds(std::chrono::steady_clock::now() - begin));

  map_points_t answer = ToMessage(visible, index_.map());
  answer.utime = message.utime;
  answer.seq = seq_++;
  answer.epoch = status_.epoch();
  answer.map_id = map_id_;
  answer.query_seq = message.seq;
  answer.query_epoch = message.epoch;
  EncodeTo(answer, &buffer_);
  bus_->Publish(channels_.map_points, buffer_.data(), buffer_.size());
}

}  // namespace evit
