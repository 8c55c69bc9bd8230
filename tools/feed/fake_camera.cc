#include "tools/feed/fake_camera.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/codec.h"
#include "common/bus/log_file.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"
#include "tools/feed/feed_records.h"

namespace evit::feed {
namespace {

using Clock = std::chrono::steady_clock;

class FakeCamera : public FeedInput {
 public:
  FakeCamera(const std::string& path, bool realtime) : path_(path), log_(path), realtime_(realtime) {
    const auto is_events = [&](const LogEntry& e) { return log_.channel(e) == channels_.events; };
    if (std::none_of(log_.entries().begin(), log_.entries().end(), is_events))
      throw std::runtime_error(path + ": has no messages on " + channels_.events +
                               "; make it with evit import");
  }

  State Read(std::uint8_t* out, std::size_t capacity, int timeout_ms, std::size_t* n) override {
    *n = 0;
    while (at_ == bytes_.size()) {
      if (next_ == log_.entries().size()) return State::kEnd;
      if (!Due(timeout_ms)) return State::kPause;
      LoadNext();
    }
    *n = std::min(capacity, bytes_.size() - at_);
    std::memcpy(out, bytes_.data() + at_, *n);
    at_ += *n;
    return State::kData;
  }
  std::string name() const override { return path_; }

 private:
  bool Due(int timeout_ms) {
    if (!realtime_) return true;
    const Utime t = log_.entries()[next_].utime;
    if (!begin_) {
      begin_ = Clock::now();
      first_ = t;
    }
    const auto due = *begin_ + std::chrono::microseconds(t - first_),
               latest = Clock::now() + std::chrono::milliseconds(timeout_ms);
    std::this_thread::sleep_until(std::min(due, latest));
    return due <= latest;
  }
  void LoadNext() {
    const LogEntry& entry = log_.entries()[next_++];
    bytes_.clear();
    at_ = 0;
    const std::string& channel = log_.channel(entry);
    if (channel != channels_.events && channel != channels_.imu) return;
    log_.Read(entry, &message_);
    std::string why;
    bool fine = false;
    if (channel == channels_.events) {
      event_packet_t packet;
      fine = DecodeChecked(message_.data(), message_.size(), &packet, &why);
      EventArray events;
      if (fine) AppendEvents(packet, &events);
      for (std::size_t k = 0; k < events.size(); ++k)
        AppendRecord(events.t[k], events.x[k], events.y[k], events.p[k], &bytes_);
    } else {
      imu_batch_t batch;
      fine = DecodeChecked(message_.data(), message_.size(), &batch, &why);
      if (fine) {
        for (const ImuSample& s : SamplesOf(batch)) AppendRecord(s, &bytes_);
      }
    }
    if (!fine) throw std::runtime_error(path_ + ": a message on " + channel + " is damaged: " + why);
  }

  std::string path_;
  LogReader log_;
  bool realtime_;
  Channels channels_;
  std::size_t next_ = 0, at_ = 0;
  std::optional<Clock::time_point> begin_;
  Utime first_ = 0;
  std::vector<std::uint8_t> message_;
  std::string bytes_;
};

}  // namespace

std::unique_ptr<FeedInput> OpenFakeCamera(const std::string& log, bool realtime) {
  return std::make_unique<FakeCamera>(log, realtime);
}

}  // namespace evit::feed
