#include "services/map_server/place_server.h"

#include <chrono>
#include <stdexcept>

#include "common/bus/codec.h"
#include "common/localization/place_finder.h"
#include "common/localization/place_index_file.h"
#include "common/wire/place_wire.h"

namespace evit {

PlaceServer::PlaceServer(Bus* bus, const Channels& channels, StatusReporter* status, const MapIndex* map)
    : bus_(bus), channel_(channels.places), status_(status), queries_(status, "PLACE_QUERY"), map_(map) {
  bus_->Subscribe(channels.place_query, [this](const std::string&, const std::uint8_t* data,
                                               std::size_t size) { OnQuery(data, size); });
}

PlaceServer::~PlaceServer() { stopping_ = true; }

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
  work_ = std::async(std::launch::async, [this, message = std::move(message)]() -> std::optional<places_t> {
    MakeIndex();
    return message ? Answer(*message) : std::nullopt;
  });
}

void PlaceServer::MakeIndex() {
  if (index_) return;
  const auto progress = [this](double share) {
    prepared_ = share;
    if (stopping_) throw std::runtime_error("stopped");
  };
  index_ = std::make_unique<const PlaceIndex>(
      ReadOrMakePlaceIndex(path_, map_->map(), PlaceIndexOptions(), progress, &index_read_));
  prepared_ = 1;
}

std::optional<places_t> PlaceServer::Answer(const place_query_t& message) {
  // What a place is like does not depend on how its points are weighted later: the defaults serve every
  // tracker.
  const PlaceFinder finder(*map_, *index_, RigOf(message), PointOptions(), WindowOptions());
  places_t answer = ToMessage(finder.Answer(FromMessage(message)));
  answer.utime = message.utime;
  answer.query_seq = message.seq;
  answer.query_epoch = message.epoch;
  return answer;
}

void PlaceServer::Tick() {
  if (busy()) {
    if (prepared_ < 1) status_->SetProgress(prepared_);
    if (work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    std::optional<places_t> answer = work_.get();
    status_->Counter("places.indexed") = static_cast<std::int64_t>(index_->places().size());
    status_->Counter("places.read") = index_read_ ? 1 : 0;
    if (answer) {
      answer->seq = seq_++;
      answer->epoch = status_->epoch();
      EncodeTo(*answer, &buffer_);
      answered_ = in_work_;
      bus_->Publish(channel_, buffer_.data(), buffer_.size());
    }
    in_work_ = {-1, -1};
  }
  if (waiting_) Begin(std::exchange(waiting_, std::nullopt));
}

}  // namespace evit
