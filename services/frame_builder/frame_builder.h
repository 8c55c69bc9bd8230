#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/events/keyframe_builder.h"
#include "common/events/stream_guard.h"
#include "common/service/credit_sender.h"
#include "common/service/runner.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "services/frame_builder/keyframe_outbox.h"
#include "services/frame_builder/stream_check.h"
#include "services/frame_builder/stream_inbox.h"

namespace evit {

/// EVENTS and IMU in, KEYFRAME out; TRACKER_MODE decides the rate and the decay. common/events makes the
/// keyframes.
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
  void OnEvents(const std::uint8_t* data, std::size_t size);
  void OnImu(const std::uint8_t* data, std::size_t size);
  void OnPut(StreamInbox::Verdict verdict);
  void OnMode(const std::uint8_t* data, std::size_t size);
  void OnEnd(const std::uint8_t* data, std::size_t size);
  void Work();
  void Feed(StreamInbox::Item item);
  void Use(EventArray* events, Utime watermark);
  void Send(Keyframe keyframe);
  void ReportState();
  void ReportCounters();

  Bus* bus_;
  Channels channels_;
  Settings settings_;
  StatusReporter status_;
  SequenceCounter modes_;
  StreamInbox inbox_;
  std::vector<EventArray> spare_;  // memory of events that have been used
  std::optional<CreditSender> credit_;
  KeyframeBuilder builder_;
  KeyframeOutbox outbox_;
  StreamGuard guard_;
  StreamCheck check_;
  bool flushed_ = false;
};

}  // namespace evit
