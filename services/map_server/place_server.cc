#include "services/map_server/place_server.h"

#include <utility>

#include "common/bus/codec.h"
#include "common/wire/place_wire.h"

namespace evit {

PlaceServer::PlaceServer(Bus* bus, const Channels& channels, StatusReporter* status, const MapIndex* map)
    : bus_(bus), channel_(channels.places), status_(status), queries_(status, "PLACE_QUERY"), worker_(map) {
  bus_->Subscribe(channels.place_query, [this](const std::string&, const std::uint8_t* data,
                                               std::size_t size) { OnQuery(data, size); });
}

void PlaceServer::Prepare() {
  if (!busy()) Begin(std::nullopt);
}

void PlaceServer::OnQuery(const std::uint8_t* data, std::size_t size) {
  place_query_t message;
  Camera::Model model{};
  if (!DecodeChecked(data, size, &message) || !CameraModelFromName(message.camera.model, &model)) {
    queries_.CountInvalid();
    return;
  }
  queries_.Commit(message.epoch, message.seq);
  const std::pair<std::int64_t, std::int64_t> number(message.epoch, message.seq);
  // A question is sent again while its answer takes long: it is searched once, and an answer that may have
  // been lost is sent again.
  if (number == in_work_) return;
  if (number == answered_) {
    bus_->Publish(channel_, buffer_.data(), buffer_.size());
    return;
  }
  waiting_ = std::move(message);
}

void PlaceServer::Begin(std::optional<place_query_t> message) {
  if (message) in_work_ = {message->epoch, message->seq};
  worker_.Begin(std::move(message));
}

void PlaceServer::Send(places_t answer) {
  answer.seq = seq_++;
  answer.epoch = status_->epoch();
  EncodeTo(answer, &buffer_);
  answered_ = in_work_;
  bus_->Publish(channel_, buffer_.data(), buffer_.size());
}

void PlaceServer::Tick() {
  if (busy()) {
    if (worker_.prepared() < 1) status_->SetProgress(worker_.prepared());
    if (!worker_.Done()) return;
    std::optional<places_t> answer = worker_.Take();
    status_->Counter("places.indexed") = static_cast<std::int64_t>(worker_.n_places());
    status_->Counter("places.read") = worker_.index_read() ? 1 : 0;
    if (answer) Send(std::move(*answer));
    in_work_ = {-1, -1};
  }
  if (waiting_) Begin(std::exchange(waiting_, std::nullopt));
}

}  // namespace evit
