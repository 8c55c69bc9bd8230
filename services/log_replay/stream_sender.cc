#include "services/log_replay/stream_sender.h"

#include <algorithm>
#include <limits>

namespace evit {

namespace {

// Every message opens with fingerprint, utime, seq and epoch, 8 bytes each, big-endian: what was checked can
// be stamped in place instead of being encoded again.
constexpr std::size_t kSeqOffset = 16;
constexpr std::size_t kEpochOffset = 24;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

void PutInt64(std::int64_t value, std::uint8_t* at) {
  for (int i = 7; i >= 0; --i, value >>= 8) at[i] = static_cast<std::uint8_t>(value & 0xFF);
}

}  // namespace

StreamSender::StreamSender(Bus* bus, const Channels& channels, const Recording* recording,
                           StatusReporter* status)
    : bus_(bus),
      recording_(recording),
      channels_{channels.events, channels.imu, channels.ground_truth},
      imu_(),
      pose_() {
  const std::array<std::string, 3> names = {"EVENTS", "IMU", "GROUND_TRUTH"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    sent_counter_[k] = &status->Counter(names[k] + ".sent");
    invalid_[k] = &status->Counter(names[k] + ".invalid");
    out_of_order_[k] = &status->Counter(names[k] + ".out_of_order");
  }
  Restart(0);
}

void StreamSender::Restart(std::int64_t epoch) {
  epoch_ = epoch;
  next_.fill(0);
  last_utime_.fill(kNever);
}

void StreamSender::Continue(const ReplayPosition& position) {
  epoch_ = position.epoch;
  next_ = position.sent;
  last_utime_ = position.last_utime;
}

void StreamSender::Save(ReplayPosition* position) const {
  position->epoch = epoch_;
  position->sent = next_;
  position->last_utime = last_utime_;
}

std::int64_t StreamSender::last_utime(std::int64_t otherwise) const {
  const std::int64_t last = *std::max_element(last_utime_.begin(), last_utime_.end());
  return last == kNever ? otherwise : last;
}

bool StreamSender::SendNew(std::size_t i) {
  const Recording::Kind kind = recording_->kind(i);
  recording_->Read(i, &bytes_);
  Span span;
  if (!Decode(kind, &span)) {
    ++*invalid_[kind];
    return false;
  }
  // Events may share an instant, samples and poses not.
  if (span.begin < last_utime_[kind] || (kind != Recording::kEvents && span.begin == last_utime_[kind])) {
    ++*out_of_order_[kind];
    return false;
  }
  last_utime_[kind] = span.end;
  Publish(kind, next_[kind]++);
  ++*sent_counter_[kind];
  return true;
}

void StreamSender::SendAgain(std::size_t i, std::int64_t seq) {
  recording_->Read(i, &bytes_);  // checked when it was new
  Publish(recording_->kind(i), seq);
}

bool StreamSender::Decode(Recording::Kind kind, Span* span) {
  switch (kind) {
    case Recording::kEvents:
      if (!DecodeEvents(bytes_.data(), bytes_.size(), &events_)) return false;
      *span = {events_.utime, events_.watermark()};
      return true;
    case Recording::kImu:
      if (!DecodeChecked(bytes_.data(), bytes_.size(), &imu_)) return false;
      *span = {imu_.utime, imu_.n > 0 ? imu_.sample_utime.back() : imu_.utime};
      return true;
    case Recording::kGroundTruth:
      if (!DecodeChecked(bytes_.data(), bytes_.size(), &pose_)) return false;
      *span = {pose_.utime, pose_.utime};
      return true;
  }
  return false;
}

void StreamSender::Publish(Recording::Kind kind, std::int64_t seq) {
  PutInt64(seq, &bytes_[kSeqOffset]);
  PutInt64(epoch_, &bytes_[kEpochOffset]);
  bus_->Publish(channels_[kind], bytes_.data(), bytes_.size());
}

}  // namespace evit
