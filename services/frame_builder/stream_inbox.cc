#include "services/frame_builder/stream_inbox.h"

#include <algorithm>
#include <utility>

namespace evit {

StreamInbox::StreamInbox(StatusReporter* status, bool lossless)
    : status_(status), lossless_(lossless), events_(status, "EVENTS"), imu_(status, "IMU") {}

StreamInbox::Verdict StreamInbox::Put(EventPacket message, std::size_t bytes) {
  return Admit(std::move(message), bytes, &events_);
}

StreamInbox::Verdict StreamInbox::Put(imu_batch_t message, std::size_t bytes) {
  return Admit(std::move(message), bytes, &imu_);
}

template <typename M>
StreamInbox::Verdict StreamInbox::Admit(M message, std::size_t bytes, SequenceCounter* counter) {
  using Seen = SequenceCounter::Verdict;
  const Seen seen = counter->Classify(message.epoch, message.seq);
  if (lossless_) {
    const bool first_of_run = seen == Seen::kNewEpoch && message.seq == 0;
    const bool next = seen != Seen::kNewEpoch && message.epoch == epoch_ && seen != Seen::kGap;
    const bool foreign = seen == Seen::kNewEpoch && counter->IsOver(message.epoch);
    if (foreign) counter->CountForeign();
    if (foreign || (!first_of_run && !next))
      return Verdict::kRefused;  // it comes again, after what is missing
  }
  const bool first_heard = counter->epoch() == -1;
  counter->Commit(message.epoch, message.seq);
  if (seen == Seen::kOld) return Verdict::kRefused;
  // The other stream may have announced this run already. Live sensors have separate epochs for both streams.
  const bool is_new =
      seen == Seen::kNewEpoch && message.epoch != epoch_ && (lossless_ || !first_heard || epoch_ == -1);
  if (is_new) {
    epoch_ = message.epoch;
    taken_events_ = taken_imu_ = 0;
    items_.clear();
    end_.reset();
  }
  items_.push_back({std::move(message), bytes});
  return is_new ? Verdict::kNewStream : Verdict::kTaken;
}

std::optional<StreamInbox::Item> StreamInbox::Take() {
  if (items_.empty()) return std::nullopt;
  Item item = std::move(items_.front());
  items_.pop_front();
  if (const auto* events = std::get_if<EventPacket>(&item.message)) {
    taken_events_ = events->seq + 1;
  } else {
    taken_imu_ = std::get<imu_batch_t>(item.message).seq + 1;
  }
  return item;
}

void StreamInbox::End(const stream_end_t& end) {
  const bool nothing_sent = end.n_events_messages == 0 && end.n_imu_messages == 0;
  const bool between_runs = epoch_ == -1 || end_.has_value();
  if (end.epoch != epoch_ && !(nothing_sent && between_runs)) return;
  if (!lossless_ && !end_) {  // nothing comes after the end: what has not come by now is lost
    status_->Counter("EVENTS.lost") += std::max<std::int64_t>(end.n_events_messages - taken_events_, 0);
    status_->Counter("IMU.lost") += std::max<std::int64_t>(end.n_imu_messages - taken_imu_, 0);
  }
  epoch_ = end.epoch;
  end_ = end;
}

bool StreamInbox::ended() const {
  if (!end_ || !items_.empty()) return false;
  return !lossless_ || (taken_events_ >= end_->n_events_messages && taken_imu_ >= end_->n_imu_messages);
}

}  // namespace evit
