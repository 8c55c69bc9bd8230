#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/events/keyframe_builder.h"
#include "common/service/credit_sender.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "services/frame_builder/stream_inbox.h"

namespace evit {

/// EVENTS and IMU in, KEYFRAME out; listens to TRACKER_MODE for the rate and the decay. What a
/// keyframe is and how it is made is in common/events.
///
/// Lossless: keyframe k is made with the TRACKER_MODE of keyframe k-2 and waits for it; meanwhile CREDIT
/// holds the streams back, and keyframes without an answer are sent again. Real time: nothing waits; an
/// optimiser that was restarted gets the keyframes since the last one it names, as far as they are still
/// held.
class FrameBuilder : public Service {
 public:
  struct Settings {
    Rig rig;
    KeyframeBuilder::Options keyframes;
    bool lossless = false;
    std::chrono::milliseconds send_again{500};  // after this without an answer
  };
  /// `bus` must outlive this.
  FrameBuilder(Bus* bus, const Channels& channels, const Settings& settings);

  void Tick() override;
  void Stop() override;

 private:
  using Clock = std::chrono::steady_clock;

  template <typename Message>
  void OnData(const std::uint8_t* data, std::size_t size);
  void OnMode(const std::uint8_t* data, std::size_t size);
  void OnEnd(const std::uint8_t* data, std::size_t size);
  void Work();
  void Feed(const StreamInbox::Item& item);
  struct Sent {
    std::int64_t seq;
    std::vector<std::uint8_t> bytes;
    bool before;  // sent already
  };
  void Send(Keyframe keyframe);
  void Publish(Sent* sent);
  void SendAgain();
  void SendHeld();
  void ReportState();
  void ReportCounters();

  Bus* bus_;
  Channels channels_;
  Settings settings_;
  StatusReporter status_;
  SequenceCounter modes_;
  StreamInbox inbox_;
  std::optional<CreditSender> credit_;
  KeyframeBuilder builder_;
  EventArray events_;

  std::deque<Sent> recent_;           // keyframes without an answer; real time: the newest ones
  std::deque<std::int64_t> to_send_;  // numbers of those to send next, first what a restarted optimiser lacks
  std::int64_t last_sent_ = -1, last_answered_ = -1;
  Clock::time_point moved_ = Clock::now();  // last keyframe sent, or answer heard
  Clock::time_point sent_again_;
  bool flushed_ = false;
};

}  // namespace evit
