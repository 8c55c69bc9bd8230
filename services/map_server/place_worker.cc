#include "services/map_server/place_worker.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "common/localization/place_finder.h"
#include "common/localization/place_index_file.h"
#include "common/wire/place_wire.h"

namespace evit {

void PlaceWorker::Begin(std::optional<place_query_t> question) {
  work_ = std::async(std::launch::async, [this, question = std::move(question)]() -> std::optional<places_t> {
    MakeIndex();
    if (!question) return {};
    return Answer(*question);
  });
}

bool PlaceWorker::Done() const {
  return work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void PlaceWorker::MakeIndex() {
  if (index_) return;
  const auto progress = [this](double share) {
    prepared_ = share;
    if (stopping_) throw std::runtime_error("stopped");
  };
  index_ = std::make_unique<const PlaceIndex>(
      ReadOrMakePlaceIndex(paths_, map_->map(), PlaceIndexOptions(), progress, &index_read_));
  prepared_ = 1;
}

places_t PlaceWorker::Answer(const place_query_t& question) const {
  // What a place is like does not depend on how its points are weighted later: the defaults serve every
  // tracker.
  const PlaceFinder finder(*map_, *index_, RigOf(question), PointOptions(), WindowOptions());
  places_t answer = ToMessage(finder.Answer(FromMessage(question)));
  answer.utime = question.utime;
  answer.query_seq = question.seq;
  answer.query_epoch = question.epoch;
  return answer;
}

}  // namespace evit
