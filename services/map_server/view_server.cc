#include "services/map_server/view_server.h"

#include <chrono>
#include <utility>

#include "common/bus/codec.h"
#include "common/time/milliseconds.h"
#include "common/wire/view_wire.h"

namespace evit {
namespace {

constexpr std::size_t kMaxQueuedViews = 4;  // views take some 10 ms each: old answers help nobody
constexpr int kMaxPixels = 640 * 512;       // a message of 1.3 MB, and the time to draw it
// The tracker waits for its view: meanwhile a second processor has nothing to do.
constexpr int kThreads = 2;

}  // namespace

ViewServer::ViewServer(Bus* bus, const Channels& channels, StatusReporter* status, const PhotometricMap& map)
    : bus_(bus),
      channel_(channels.map_view),
      status_(status),
      queries_(status, "VIEW_QUERY"),
      dropped_(&status->Counter("VIEW_QUERY.dropped")),
      renderer_(map, ViewRenderer::kDark, kThreads) {
  bus_->Subscribe(channels.view_query, [this](const std::string&, const std::uint8_t* data,
                                              std::size_t size) { OnQuery(data, size); });
  status_->Counter("photometric_map.points") = static_cast<std::int64_t>(renderer_.size());
}

void ViewServer::OnQuery(const std::uint8_t* data, std::size_t size) {
  view_query_t message;
  if (!DecodeChecked(data, size, &message) ||
      std::int64_t{message.camera.width} * message.camera.height > kMaxPixels) {
    queries_.CountInvalid();
    return;
  }
  queries_.Commit(message.epoch, message.seq);
  const std::pair<std::int64_t, std::int64_t> number(message.epoch, message.seq);
  // A query is sent again while its answer takes long: the view is drawn once, and an answer that may have
  // been lost is sent again.
  for (const view_query_t& waiting : queue_) {
    if (number == std::make_pair(waiting.epoch, waiting.seq)) return;
  }
  if (number == answered_) {
    bus_->Publish(channel_, buffer_.data(), buffer_.size());
    return;
  }
  if (queue_.size() == kMaxQueuedViews) {
    queue_.pop_front();
    ++*dropped_;
  }
  queue_.push_back(std::move(message));
}

void ViewServer::Tick() {
  for (; !queue_.empty(); queue_.pop_front()) Answer(queue_.front());
}

void ViewServer::Answer(const view_query_t& message) {
  const auto begin = std::chrono::steady_clock::now();
  renderer_.Render(FromMessage(message), &view_);
  status_->AddTiming("view", Milliseconds(std::chrono::steady_clock::now() - begin));
  map_view_t answer = ToMessage(view_);
  answer.utime = message.utime;
  answer.seq = seq_++;
  answer.epoch = status_->epoch();
  answer.query_seq = message.seq;
  answer.query_epoch = message.epoch;
  EncodeTo(answer, &buffer_);
  answered_ = {message.epoch, message.seq};
  bus_->Publish(channel_, buffer_.data(), buffer_.size());
}

}  // namespace evit
