#include "services/frame_builder/frame_builder.h"

#include <algorithm>
#include <utility>

#include "common/bus/codec.h"
#include "common/wire/imu_wire.h"
#include "common/wire/keyframe_wire.h"

namespace evit {
namespace {

constexpr auto kPatience = std::chrono::seconds(2);  // before the missing answer is complained of
constexpr std::size_t kMaxSpare = 32;                // packets: more than lossless replay has under way

}  // namespace

FrameBuilder::FrameBuilder(Bus* bus, const Channels& channels, const Settings& settings)
    : bus_(bus),
      channels_(channels),
      settings_(settings),
      status_(bus, channels, "frame_builder", NewEpoch()),
      modes_(&status_, "TRACKER_MODE"),
      inbox_(&status_, settings.lossless),
      builder_(settings.rig, settings.keyframes, settings.lossless),
      outbox_(bus, channels.keyframe, &status_, settings.lossless, settings.send_again),
      check_(!settings.keyframes.without_imu) {
  const auto on = [&](const std::string& channel, auto method) {
    bus_->Subscribe(channel, [this, method](const std::string&, const std::uint8_t* data, std::size_t size) {
      (this->*method)(data, size);
    });
  };
  on(channels_.events, &FrameBuilder::OnEvents);
  on(channels_.imu, &FrameBuilder::OnImu);
  on(channels_.tracker_mode, &FrameBuilder::OnMode);
  on(channels_.stream_end, &FrameBuilder::OnEnd);
  if (settings_.lossless) credit_.emplace(bus_, channels_, "frame_builder", status_.epoch());
  status_.SetState("waiting", settings_.keyframes.without_imu ? "waiting for events"
                                                              : "waiting for events and IMU samples");
}

void FrameBuilder::OnEvents(const std::uint8_t* data, std::size_t size) {
  EventPacket packet;
  if (!spare_.empty()) {
    packet.events = std::move(spare_.back());
    spare_.pop_back();
  }
  if (DecodeEvents(data, size, &packet)) {
    OnPut(inbox_.Put(std::move(packet), size));
  } else {
    inbox_.CountInvalidEvents();
  }
}

void FrameBuilder::OnImu(const std::uint8_t* data, std::size_t size) {
  imu_batch_t message;
  if (DecodeChecked(data, size, &message)) {
    OnPut(inbox_.Put(std::move(message), size));
  } else {
    inbox_.CountInvalidImu();
  }
}

void FrameBuilder::OnPut(StreamInbox::Verdict verdict) {
  if (verdict == StreamInbox::Verdict::kRefused) {
    if (credit_) credit_->Ask();  // the sender should know where we are
    return;
  }
  if (verdict == StreamInbox::Verdict::kNewStream) {
    builder_.Reset();
    guard_.Clear();
    check_.Clear();
    flushed_ = false;
  }
  Work();
}

void FrameBuilder::Use(EventArray* events, Utime watermark) {
  builder_.AddEvents(*events, watermark);
  if (spare_.size() < kMaxSpare) spare_.push_back(std::move(*events));
}

void FrameBuilder::Feed(StreamInbox::Item item) {
  if (auto* const packet = std::get_if<EventPacket>(&item.message)) {
    const Utime watermark = packet->watermark();
    check_.AddEvents(watermark);
    guard_.AddEvents(std::move(packet->events), watermark,
                     [&](EventArray& good, Utime known) { Use(&good, known); });
  } else {
    for (const ImuSample& s : SamplesOf(std::get<imu_batch_t>(item.message))) {
      check_.AddImu(s);
      guard_.AddImu(s, [&](const ImuSample& good) { builder_.AddImu(good); });
    }
  }
  if (credit_) {
    credit_->Consumed(inbox_.epoch(), inbox_.taken_events(), inbox_.taken_imu(), item.bytes);
  }
}

void FrameBuilder::Work() {
  while (true) {
    while (auto keyframe = builder_.Next()) Send(std::move(*keyframe));
    if (builder_.awaited_feedback() >= 0) break;  // what is in the inbox waits, and with it the sender
    if (auto item = inbox_.Take()) {
      Feed(std::move(*item));
    } else if (!flushed_ && inbox_.ended()) {
      guard_.Flush([&](EventArray& good, Utime known) { Use(&good, known); },
                   [&](const ImuSample& good) { builder_.AddImu(good); });
      builder_.Flush();
      flushed_ = true;
      if (credit_) credit_->Ask();  // so that the sender knows at once that all has arrived
    } else {
      break;
    }
  }
  ReportState();
}

void FrameBuilder::ReportState() {
  const std::int64_t awaited = builder_.awaited_feedback();
  if (settings_.lossless && inbox_.two_senders()) {
    status_.SetState(
        "failed",
        "two senders on EVENTS or IMU: another replay or driver is on this bus; give one of them --prefix "
        "or a port of its own");
    return;
  }
  if (awaited >= 0 && std::chrono::steady_clock::now() - outbox_.last_progress() > kPatience) {
    status_.SetState("waiting", "window_optimizer does not answer keyframe " + std::to_string(awaited) +
                                    ": is it running, --lossless, on the same URL and prefix?");
  } else if (flushed_ && awaited < 0) {
    if (status_.state() == "drained") return;
    ReportCounters();
    status_.SetState("drained",
                     "the streams have ended; last keyframe " + std::to_string(outbox_.last_sent()));
  } else if (const std::string complaint = check_.Complaint(); !complaint.empty()) {
    status_.SetState("degraded", complaint);
  } else if (inbox_.epoch() != -1 && outbox_.last_sent() < 0) {
    status_.SetState("running", "filling the surface with events");
  } else if (inbox_.epoch() != -1) {
    status_.SetState("running", "making keyframes");
  }
}

void FrameBuilder::Send(Keyframe keyframe) {
  status_.AddTiming("update", keyframe.update_ms);
  status_.AddTiming("render", keyframe.render_ms);
  outbox_.Send(std::move(keyframe));
}

void FrameBuilder::OnMode(const std::uint8_t* data, std::size_t size) {
  tracker_mode_t message;
  if (!DecodeChecked(data, size, &message)) {
    modes_.CountInvalid();
    return;
  }
  if (modes_.Commit(message.epoch, message.seq) == SequenceCounter::Verdict::kOld) return;
  // Before its first keyframe the tracker speaks of none, after our restart of an earlier run's.
  const bool ours = message.keyframe_epoch == status_.epoch() && message.keyframe_seq >= 0 &&
                    message.keyframe_seq <= outbox_.last_sent();
  if (!ours) {
    ++status_.Counter("TRACKER_MODE.not_ours");
    if (settings_.lossless || message.keyframe_seq < 0) return;
    builder_.SetFeedbackFor(-1, ToFeedback(message));
    return;
  }
  outbox_.OnAnswer(message);
  builder_.SetFeedbackFor(message.keyframe_seq, ToFeedback(message));
  if (builder_.awaited_feedback() >= 0) Work();
}

void FrameBuilder::OnEnd(const std::uint8_t* data, std::size_t size) {
  stream_end_t message;
  if (!DecodeChecked(data, size, &message)) {
    ++status_.Counter("STREAM_END.invalid");
    return;
  }
  inbox_.End(message);
  Work();
}

void FrameBuilder::ReportCounters() {
  const StreamMerger::Counters& c = builder_.counters();
  status_.Counter("events.outside") = c.events_outside;
  status_.Counter("events.late") = c.events_late;
  status_.Counter("events.ahead") = guard_.counters().events_ahead;
  status_.Counter("events.sorted") = guard_.counters().events_sorted;
  status_.Counter("imu.ahead") = guard_.counters().imu_ahead;
  status_.Counter("imu.samples") = guard_.counters().imu;
  status_.Counter("events.overrun") = builder_.events_overrun();
  status_.Counter("imu.late") = c.imu_late;
  status_.Counter("imu.invalid") = c.imu_invalid;
  status_.Counter("clock_resets") = c.resets;
  status_.Counter("inbox.queued") = static_cast<std::int64_t>(inbox_.size());
}

void FrameBuilder::Tick() {
  outbox_.Tick();
  ReportState();
  if (credit_) credit_->Tick();
  ReportCounters();
  status_.Tick();
}

void FrameBuilder::Stop() {
  ReportCounters();
  status_.SetState("finished", "stopped");
}

}  // namespace evit
