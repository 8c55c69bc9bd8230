#include "services/window_optimizer/request_client.h"

#include <string>
#include <utility>

#include "common/bus/codec.h"
#include "common/time/milliseconds.h"

namespace evit {

template <typename Request>
RequestClient<Request>::RequestClient(Bus* bus, const Channels& channels, StatusReporter* status,
                                      const Patience& patience, Clock::time_point now)
    : status_(status),
      patience_(patience),
      sender_(bus, Request::QueryChannel(channels), status->epoch()),
      silent_since_(now) {}

template <typename Request>
void RequestClient<Request>::Ask(const Query& query, Clock::time_point now) {
  if (answered_) silent_since_ = now;
  answered_ = false;
  answer_.reset();
  query_ = query;
  first_asked_ = asked_ = now;
  sender_.Send(&query_);
}

// The number of the question tells which answer is awaited: it stays.
template <typename Request>
void RequestClient<Request>::Tick(Clock::time_point now) {
  if (answered_ || now - asked_ <= kAskAgain) return;
  ++status_->Counter(std::string(Request::kQueryName) + ".sent_again");
  sender_.SendAgain(query_);
  asked_ = now;
}

template <typename Request>
bool RequestClient<Request>::OnAnswer(const std::uint8_t* data, std::size_t size, Clock::time_point now) {
  const std::string name = Request::kAnswerName;
  Answer answer;
  if (!DecodeChecked(data, size, &answer)) {
    ++status_->Counter(name + ".invalid");
    return false;
  }
  ++status_->Counter(name + ".received");
  silent_since_ = now;
  if (answered_ || answer.query_epoch != query_.epoch || answer.query_seq != query_.seq) return false;
  if (!Request::Fits(query_, answer)) {
    ++status_->Counter(name + ".invalid");
    return false;
  }
  answered_ = true;
  answer_ = std::move(answer);
  status_->AddTiming(Request::kTiming, Milliseconds(now - first_asked_));
  return true;
}

template <typename Request>
std::optional<typename Request::Answer> RequestClient<Request>::TakeAnswer() {
  return std::exchange(answer_, std::nullopt);
}

template <typename Request>
bool RequestClient<Request>::GivenUp(Clock::time_point now) const {
  return !answered_ && (now - silent_since_ > patience_.silence || now - first_asked_ > patience_.answer);
}

template class RequestClient<MapPointsRequest>;
template class RequestClient<MapViewRequest>;
template class RequestClient<PlacesRequest>;

}  // namespace evit
