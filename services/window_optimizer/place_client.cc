#include "services/window_optimizer/place_client.h"

#include <utility>

#include "common/bus/codec.h"
#include "common/bus/subscribe.h"
#include "common/wire/place_wire.h"

namespace evit {

PlaceClient::PlaceClient(Bus* bus, const Channels& channels, StatusReporter* status, const Rig& rig,
                         Clock::time_point now)
    : client_(bus, channels, status, {std::chrono::milliseconds(20)}, now),
      rig_(rig),
      priors_(status, "PLACE_PRIOR") {
  Subscribe(bus, channels.place_prior, this, &PlaceClient::OnPrior);
}

void PlaceClient::OnPrior(const std::uint8_t* data, std::size_t size) {
  place_prior_t message;
  if (!DecodeChecked(data, size, &message)) {
    priors_.CountInvalid();
    return;
  }
  if (priors_.Commit(message.epoch, message.seq) != SequenceCounter::Verdict::kOld)
    prior_ = FromMessage(message);
}

void PlaceClient::Serve(MapTracker* tracker, Clock::time_point now) {
  if (prior_) tracker->SetPlacePrior(*std::exchange(prior_, std::nullopt));
  const PlaceQuery* question = tracker->PlaceQuestion();
  while (question != nullptr && question->number == asked_) {
    const std::optional<places_t> answer = client_.TakeAnswer();
    if (!answer) return;
    tracker->AddPlaces(PlacesOf(*answer));
    asked_ = 0;
    question = tracker->PlaceQuestion();
  }
  asked_ = question == nullptr ? 0 : question->number;
  if (question != nullptr) client_.Ask(ToMessage(*question, rig_), now);
}

bool PlaceClient::OnAnswer(const std::uint8_t* data, std::size_t size, Clock::time_point now) {
  return client_.OnAnswer(data, size, now) && asked_ != 0;
}

void PlaceClient::Tick(Clock::time_point now) {
  if (asked_ != 0) client_.Tick(now);
}

}  // namespace evit
