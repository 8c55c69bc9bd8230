#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/wire/event_wire.h"
#include "common/wire/imu_wire.h"
#include "tests/helpers/bus_messages.h"
#include "tests/helpers/event_streams.h"

/// What stands around frame_builder in a pipeline, for its tests.
namespace evit::test {

/// The messages of a recording, in the order of their time; `packet`: events in one EVENTS message.
struct RecordedMessages {
  std::vector<event_packet_t> events;
  std::vector<imu_batch_t> imu;
};

inline RecordedMessages MakeRecording(std::size_t packet, Utime duration = 1'000'000) {
  const Utime begin = 1'000'000;
  const EventArray all = RandomStream(begin, begin + duration, 60'000, 3);
  RecordedMessages r;
  for (std::size_t i = 0; i < all.size(); i += packet) {
    const EventArray part = Slice(all, i, std::min(i + packet, all.size()));
    r.events.push_back(ToPackets(part, 0, static_cast<std::int64_t>(r.events.size())).at(0));
  }
  for (const ImuSample& s : ImuStream(begin + 1'000, begin + duration - 5'000)) {
    imu_batch_t m = ToMessage(s);
    m.seq = static_cast<std::int64_t>(r.imu.size());
    r.imu.push_back(m);
  }
  return r;
}

/// Sends a recording like log_replay does without losses: from the first message frame_builder's credit
/// lacks.
class Sender {
 public:
  Sender(Bus* bus, RecordedMessages recording, std::int64_t epoch)
      : bus_(bus), recording_(std::move(recording)), epoch_(epoch) {
    Listen<credit_t>(bus, Channels().credit, [this](const credit_t& m) { credit = m; });
  }
  /// Sends up to `n` more messages; false where there are none.
  bool SendSome(std::size_t n) {
    for (; n > 0; --n) {
      const bool events_left = e_ < recording_.events.size(), imu_left = m_ < recording_.imu.size();
      if (!events_left && !imu_left) return false;
      if (events_left && (!imu_left || recording_.events[e_].utime <= recording_.imu[m_].utime)) {
        recording_.events[e_].epoch = epoch_;
        Publish(bus_, Channels().events, recording_.events[e_++]);
      } else {
        recording_.imu[m_].epoch = epoch_;
        Publish(bus_, Channels().imu, recording_.imu[m_++]);
      }
    }
    return true;
  }
  /// Begins again at the first message that the newest credit says is missing.
  void GoBack() {
    const bool ours = credit.stream_epoch == epoch_;
    e_ = ours ? static_cast<std::size_t>(credit.next_events_seq) : 0;
    m_ = ours ? static_cast<std::size_t>(credit.next_imu_seq) : 0;
  }
  void SendEnd() {
    stream_end_t end{};
    end.epoch = epoch_;
    end.n_events_messages = static_cast<std::int64_t>(recording_.events.size());
    end.n_imu_messages = static_cast<std::int64_t>(recording_.imu.size());
    Publish(bus_, Channels().stream_end, end);
  }
  credit_t credit{};

 private:
  Bus* bus_;
  RecordedMessages recording_;
  std::int64_t epoch_;
  std::size_t e_ = 0, m_ = 0;
};

/// Answers keyframes like window_optimizer, by a script: five keyframes of bootstrapping, then tracking.
class Tracker {
 public:
  explicit Tracker(Bus* bus) : bus_(bus) {
    Listen<keyframe_t>(bus, Channels().keyframe, [this](const keyframe_t& m) { OnKeyframe(m); });
    Listen<service_status_t>(bus, Channels().status, [this](const service_status_t& m) {
      state = m.state;
      for (int i = 0; i < m.n_counters; ++i) counters[m.counter_name[i]] = m.counter_value[i];
    });
  }
  /// Answers to keyframes not answered yet.
  void Answer() {
    for (; answered_ < keyframes.size(); ++answered_) AnswerTo(keyframes[answered_]);
  }

  std::vector<keyframe_t> keyframes;  // each once, in order
  bool answer_at_once = true;
  int drop_every = 0;  // keyframes lost on the way
  int dropped = 0, twice = 0;
  std::string state;
  std::map<std::string, std::int64_t> counters;

 private:
  void OnKeyframe(const keyframe_t& m) {
    if (drop_every > 0 && ++heard_ % drop_every == 0) {
      ++dropped;
      return;
    }
    if (m.seq < static_cast<std::int64_t>(keyframes.size())) {
      ++twice;
      if (answer_at_once) AnswerTo(keyframes.back());
      return;
    }
    if (m.seq > static_cast<std::int64_t>(keyframes.size())) return;  // exactly the next
    keyframes.push_back(m);
    if (answer_at_once) Answer();
  }
  void AnswerTo(const keyframe_t& m) {
    tracker_mode_t mode{};
    mode.keyframe_stride = 1;
    mode.utime = m.utime;
    mode.seq = seq_++;
    mode.epoch = 5;
    mode.keyframe_seq = m.seq;
    mode.keyframe_epoch = m.epoch;
    mode.mode = m.seq < 5 ? tracker_mode_t::BOOTSTRAPPING : tracker_mode_t::TRACKING;
    mode.image_speed = m.seq < 5 ? 0 : 200 + 50.0 * static_cast<double>(m.seq % 7);
    Publish(bus_, Channels().tracker_mode, mode);
  }

  Bus* bus_;
  std::size_t answered_ = 0;
  std::int64_t seq_ = 0;
  int heard_ = 0;
};

}  // namespace evit::test
