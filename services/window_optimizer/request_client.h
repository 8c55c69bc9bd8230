#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/service/numbered_sender.h"
#include "common/service/status_reporter.h"
#include "evit/map_points_t.hpp"
#include "evit/map_query_t.hpp"
#include "evit/map_view_t.hpp"
#include "evit/place_query_t.hpp"
#include "evit/places_t.hpp"
#include "evit/view_query_t.hpp"

namespace evit {

/// Which points of the map are visible from somewhere.
struct MapPointsRequest {
  using Query = map_query_t;
  using Answer = map_points_t;
  static constexpr char kQueryName[] = "MAP_QUERY", kAnswerName[] = "MAP_POINTS";
  static constexpr char kTiming[] = "map_answer";
  static const std::string& QueryChannel(const Channels& channels) { return channels.map_query; }
  static bool Fits(const Query& /*query*/, const Answer& /*answer*/) { return true; }
};

/// How the photometric map looks from somewhere.
struct MapViewRequest {
  using Query = view_query_t;
  using Answer = map_view_t;
  static constexpr char kQueryName[] = "VIEW_QUERY", kAnswerName[] = "MAP_VIEW";
  static constexpr char kTiming[] = "map_answer";
  static const std::string& QueryChannel(const Channels& channels) { return channels.view_query; }
  static bool Fits(const Query& query, const Answer& answer) {
    return answer.width == query.camera.width && answer.height == query.camera.height;
  }
};

/// Where in the map a keyframe may have been seen from.
struct PlacesRequest {
  using Query = place_query_t;
  using Answer = places_t;
  static constexpr char kQueryName[] = "PLACE_QUERY", kAnswerName[] = "PLACES";
  static constexpr char kTiming[] = "place_answer";
  static const std::string& QueryChannel(const Channels& channels) { return channels.place_query; }
  static bool Fits(const Query& query, const Answer& answer) { return answer.n >= query.n; }
};

/// Asks map_server one question at a time, asks again while no answer comes, and knows when to continue
/// without one. Instantiated for the three above.
///
/// Counts QUERY.sent_again, ANSWER.received and ANSWER.invalid in STATUS, by the names of the request.
template <typename Request>
class RequestClient {
 public:
  using Query = typename Request::Query;
  using Answer = typename Request::Answer;
  using Clock = std::chrono::steady_clock;
  static constexpr auto kAskAgain = std::chrono::milliseconds(200);
  static constexpr auto kNoServer = std::chrono::seconds(2);

  /// How long an answer is worth waiting for.
  struct Patience {
    Clock::duration answer;                            // to one question
    Clock::duration silence = Clock::duration::max();  // since the server was last heard, over all questions
  };
  /// `bus` and `status` must outlive this.
  RequestClient(Bus* bus, const Channels& channels, StatusReporter* status, const Patience& patience,
                Clock::time_point now);

  /// Asks. The question before is dropped, and so is its answer where nobody has taken it.
  void Ask(const Query& query, Clock::time_point now);
  /// Call often: sends a question again, the very same, that has had no answer for kAskAgain.
  void Tick(Clock::time_point now);
  /// A message of the answers' channel. True where it is the answer to the question.
  bool OnAnswer(const std::uint8_t* data, std::size_t size, Clock::time_point now);

  bool answered() const { return answered_; }
  /// The answer, once.
  std::optional<Answer> TakeAnswer();
  /// Not answered, and not worth waiting for any longer.
  bool GivenUp(Clock::time_point now) const;
  /// Not answered for so long that map_server is not there.
  bool ServerTimedOut(Clock::time_point now) const { return !answered_ && now - first_asked_ > kNoServer; }

 private:
  StatusReporter* status_;
  Patience patience_;
  NumberedSender<Query> sender_;
  Query query_{};
  std::optional<Answer> answer_;  // not taken yet
  bool answered_ = false;
  Clock::time_point first_asked_, asked_;  // this question, and the last time it was sent
  Clock::time_point silent_since_;         // the server has not been heard since, though asked
};

extern template class RequestClient<MapPointsRequest>;
extern template class RequestClient<MapViewRequest>;
extern template class RequestClient<PlacesRequest>;

}  // namespace evit
