#include "services/frame_builder/keyframe_outbox.h"

#include <utility>

#include "common/bus/codec.h"
#include "common/time/milliseconds.h"
#include "common/wire/keyframe_wire.h"

namespace evit {
namespace {

constexpr std::size_t kMostHeld = 32;  // keyframes

}  // namespace

KeyframeOutbox::KeyframeOutbox(Bus* bus, std::string channel, StatusReporter* status, bool lossless,
                               std::chrono::milliseconds send_again)
    : bus_(bus), channel_(std::move(channel)), status_(status), lossless_(lossless), send_again_(send_again) {
  status_->Counter("last_keyframe_seq") = last_sent_;
}

void KeyframeOutbox::Send(Keyframe keyframe) {
  const auto begin = Clock::now();
  keyframe_t message = ToMessage(std::move(keyframe));
  message.epoch = status_->epoch();
  Sent sent{message.seq, {}, false};
  if (held_.size() >= kMostHeld) {
    sent.bytes = std::move(held_.front().bytes);  // its memory
    held_.pop_front();
  }
  EncodeTo(message, &sent.bytes);
  last_progress_ = Clock::now();
  status_->AddTiming("encode", Milliseconds(last_progress_ - begin));
  last_sent_ = sent.seq;
  held_.push_back(std::move(sent));
  if (to_send_.empty()) {
    Publish(&held_.back());
  } else {
    to_send_.push_back(last_sent_);  // behind those that are sent again: it would leave a hole before it
  }
  status_->Counter("last_keyframe_seq") = last_sent_;
}

void KeyframeOutbox::Publish(Sent* sent) {
  bus_->Publish(channel_, sent->bytes.data(), sent->bytes.size());
  ++status_->Counter(sent->sent ? "KEYFRAME.sent_again" : "KEYFRAME.sent");
  sent->sent = true;
}

void KeyframeOutbox::OnAnswer(const tracker_mode_t& answer) {
  if (!lossless_ && answer.resend != 0 && to_send_.empty()) {
    for (const Sent& sent : held_) {
      if (sent.seq > answer.keyframe_seq) to_send_.push_back(sent.seq);
    }
  }
  if (answer.keyframe_seq > last_answered_) {
    last_answered_ = answer.keyframe_seq;
    last_progress_ = Clock::now();
  }
  while (lossless_ && !held_.empty() && held_.front().seq <= last_answered_) held_.pop_front();
}

void KeyframeOutbox::Tick() {
  SendUnanswered();
  SendMissing();
}

void KeyframeOutbox::SendUnanswered() {
  const Clock::time_point now = Clock::now();
  if (!lossless_ || held_.empty() || now - sent_again_ < send_again_ || now - last_progress_ < send_again_)
    return;
  for (Sent& sent : held_) Publish(&sent);  // the optimiser takes them in exact order only
  sent_again_ = Clock::now();
}

// Few at each call: all at once would not fit the receive buffer.
void KeyframeOutbox::SendMissing() {
  constexpr std::size_t kLongQueue = 8;
  int n = to_send_.size() > kLongQueue ? 4 : 1;
  while (n > 0 && !to_send_.empty()) {
    const std::int64_t seq = to_send_.front();
    to_send_.pop_front();
    for (Sent& sent : held_) {  // it may not be held any more
      if (sent.seq != seq) continue;
      Publish(&sent);
      --n;
    }
  }
}

}  // namespace evit
