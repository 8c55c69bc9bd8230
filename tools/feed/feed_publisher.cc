#include "tools/feed/feed_publisher.h"

#include <algorithm>
#include <utility>

#include "common/bus/codec.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::feed {
namespace {

constexpr Utime kPacketSpan = 5'000;  // us
constexpr Utime kSilence = 20'000;  // us that events may be behind the IMU before the camera counts as silent
constexpr Utime kAlignFor = 1'000'000;  // us of arrivals that the clocks are compared over
constexpr Utime kLargest = std::numeric_limits<Utime>::max();

}  // namespace

FeedPublisher::FeedPublisher(const FeedOptions& options, const Channels& channels, std::int64_t epoch,
                             Send send)
    : options_(options),
      channels_(channels),
      epoch_(epoch),
      send_(std::move(send)),
      aligned_(!options.align_clocks),
      event_delay_(kLargest),
      imu_delay_(kLargest) {
  counts_.imu_offset = options.imu_offset;
}

void FeedPublisher::AddEvent(Utime t, std::uint16_t x, std::uint16_t y, std::uint8_t p) {
  if (t < last_event_ || t < known_) {
    ++counts_.late;
    return;
  }
  if (options_.width > 0 && (x >= options_.width || y >= options_.height)) {
    ++counts_.outside;
    return;
  }
  if (packet_.size() > 0 && (packet_.size() >= kPacketEvents || t - packet_.t.front() >= kPacketSpan))
    Flush();
  packet_.push_back(t, x, y, p);
  last_event_ = t;
}

void FeedPublisher::Flush() {
  if (packet_.size() == 0) return;
  known_ = packet_.t.back();
  counts_.events += static_cast<std::int64_t>(packet_.size());
  for (std::size_t begin = 0; begin < packet_.size();) {
    begin = EncodePacket(packet_, begin, epoch_, counts_.packets++, &buffer_);
    send_(known_, channels_.events, buffer_);
  }
  packet_.clear();
}

void FeedPublisher::SendImu(ImuSample sample) {
  sample.t += counts_.imu_offset;
  if (!sample.gyro.allFinite() || !sample.accel.allFinite()) {
    ++counts_.invalid;
    return;
  }
  if (sample.t <= last_imu_) {
    ++counts_.late;
    return;
  }
  last_imu_ = sample.t;
  imu_batch_t message = ToMessage(sample);
  message.seq = counts_.imu++;
  message.epoch = epoch_;
  EncodeTo(message, &buffer_);
  send_(sample.t, channels_.imu, buffer_);
  if (packet_.size() == 0 && known_ != kNever && sample.t - known_ > 2 * kSilence) {
    known_ = sample.t - kSilence;
    EncodeTo(EmptyPacket(known_, epoch_, counts_.packets++), &buffer_);
    send_(known_, channels_.events, buffer_);
  }
}

// Nothing arrives before it is stamped, so the smallest delay of each stream is nearest to the offset of its
// clock.
void FeedPublisher::Align(const EventArray& events, const std::vector<ImuSample>& imu, Utime now) {
  if (aligning_since_ == kNever) aligning_since_ = now;
  if (events.size() > 0) event_delay_ = std::min(event_delay_, now - events.t.back());
  for (const ImuSample& s : imu) imu_delay_ = std::min(imu_delay_, now - s.t);
  if (now - aligning_since_ < kAlignFor || event_delay_ == kLargest || imu_delay_ == kLargest) return;
  counts_.imu_offset += imu_delay_ - event_delay_;
  aligned_ = true;
}

void FeedPublisher::Add(const EventArray& events, const std::vector<ImuSample>& imu, Utime now) {
  for (std::size_t k = 0; k < events.size(); ++k)
    AddEvent(events.t[k], events.x[k], events.y[k], events.p[k]);
  if (!aligned_) {
    held_.insert(held_.end(), imu.begin(), imu.end());
    Align(events, imu, now);
    if (!aligned_) return;
    for (const ImuSample& s : std::exchange(held_, {})) SendImu(s);
    return;
  }
  for (const ImuSample& s : imu) SendImu(s);
}

void FeedPublisher::Close() {
  Flush();
  for (const ImuSample& s : std::exchange(held_, {})) SendImu(s);
}

}  // namespace evit::feed
