#include "tools/formats/import/stream_writer.h"

#include <algorithm>
#include <utility>

#include "common/bus/codec.h"
#include "common/wire/event_wire.h"
#include "common/wire/geometry_wire.h"
#include "common/wire/imu_wire.h"

namespace evit::formats {
namespace {

constexpr Utime kPacketSpan = 5'000;  // us
constexpr Utime kSilence = 10'000;    // us without events until an empty packet says so

}  // namespace

StreamWriter::StreamWriter(const std::string& path, std::int64_t epoch, std::vector<ImuSample> imu,
                           Trajectory truth)
    : log_(path), epoch_(epoch), imu_(std::move(imu)), truth_(std::move(truth)) {}

template <typename Message>
void StreamWriter::Write(Utime t, const std::string& channel, const Message& message) {
  EncodeTo(message, &buffer_);
  log_.Write(t, channel, buffer_.data(), buffer_.size());
}

void StreamWriter::WriteOthers(Utime until) {
  while (true) {
    const bool has_imu = next_imu_ < imu_.size() && imu_[next_imu_].t <= until;
    const bool has_truth = next_truth_ < truth_.size() && truth_[next_truth_].t <= until;
    if (!has_imu && !has_truth) return;
    if (has_imu && (!has_truth || imu_[next_imu_].t <= truth_[next_truth_].t)) {
      const ImuSample& s = imu_[next_imu_];
      imu_batch_t m = ToMessage(s);
      m.seq = static_cast<std::int64_t>(next_imu_++);
      m.epoch = epoch_;
      Write(s.t, channels_.imu, m);
    } else {
      const StampedPose& s = truth_[next_truth_];
      body_pose_t m{};
      m.utime = s.t;
      m.seq = static_cast<std::int64_t>(next_truth_++);
      m.epoch = epoch_;
      PutPose(s.pose, &m);
      Write(s.t, channels_.ground_truth, m);
    }
  }
}

void StreamWriter::FlushPacket() {
  if (packet_.size() == 0) return;
  known_ = packet_.t.back();
  WriteOthers(*known_);
  for (std::size_t begin = 0; begin < packet_.size(); ++n_packets_) {
    begin = EncodePacket(packet_, begin, epoch_, n_packets_, &buffer_);
    log_.Write(*known_, channels_.events, buffer_.data(), buffer_.size());
  }
  packet_.clear();
}

void StreamWriter::WriteWatermark(Utime t) {
  known_ = t;
  WriteOthers(t);
  Write(t, channels_.events, EmptyPacket(t, epoch_, n_packets_++));
}

void StreamWriter::AddEvent(Utime t, std::uint16_t x, std::uint16_t y, std::uint8_t polarity) {
  if (packet_.size() > 0 && (packet_.size() >= kPacketEvents || t - packet_.t.front() >= kPacketSpan))
    FlushPacket();
  if (packet_.size() == 0 && known_) {
    while (t - *known_ > kSilence) WriteWatermark(*known_ + kSilence);
  }
  packet_.push_back(t, x, y, polarity);
}

void StreamWriter::AddEvents(const EventArray& events, std::size_t begin, std::size_t end) {
  const auto append = [](auto* to, const auto& from, std::size_t first, std::size_t last) {
    to->insert(to->end(), from.begin() + static_cast<std::ptrdiff_t>(first),
               from.begin() + static_cast<std::ptrdiff_t>(last));
  };
  while (begin < end) {
    AddEvent(events.t[begin], events.x[begin], events.y[begin], events.p[begin]);
    ++begin;
    // All that belong into the same packet at once.
    const auto from = events.t.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::size_t most = std::min(end - begin, kPacketEvents - std::min(kPacketEvents, packet_.size()));
    const auto to =
        std::lower_bound(from, from + static_cast<std::ptrdiff_t>(most), packet_.t.front() + kPacketSpan);
    const std::size_t stop = begin + static_cast<std::size_t>(to - from);
    append(&packet_.t, events.t, begin, stop);
    append(&packet_.x, events.x, begin, stop);
    append(&packet_.y, events.y, begin, stop);
    append(&packet_.p, events.p, begin, stop);
    begin = stop;
  }
}

void StreamWriter::Close(Utime end) {
  FlushPacket();
  while (*known_ + kSilence < end) WriteWatermark(*known_ + kSilence);
  if (*known_ < end) WriteWatermark(end);
  WriteOthers(end);
  log_.Close();
}

}  // namespace evit::formats
