#include "services/log_replay/log_replay.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "common/bus/codec.h"
#include "common/service/credit_sender.h"

namespace evit {

namespace {

constexpr char kName[] = "log_replay";
constexpr std::int64_t kWindow = 1 << 20;        // bytes under way at most
constexpr std::int64_t kTwoPackets = 128 << 10;  // bytes
constexpr std::int64_t kOverhead = 512;  // bytes: what a datagram costs the receive buffer beyond its data
constexpr int kBurst = 64;               // messages between two looks at the bus
constexpr std::int64_t kReportPeriodUs = 200'000;

/// Bytes that may be under way: 1 MiB, or a quarter of the receive buffer where that is less, but not below
/// two full packets if these leave three eighths of it free: with one packet at a time, sender and consumer
/// would take turns.
std::int64_t WindowSize(std::int64_t granted_receive_buffer) {
  if (granted_receive_buffer <= 0) return kWindow;
  // Consumers run on this host and get the buffer this process got.
  const std::int64_t two_packets = std::min(kTwoPackets, granted_receive_buffer * 5 / 8);
  return std::clamp(granted_receive_buffer / 4, two_packets, kWindow);
}

}  // namespace

LogReplay::LogReplay(const LogReplayOptions& options, Bus* bus, const Channels& channels)
    : options_(options),
      recording_(options.log, options.log_prefix, options.allow_truncated),
      status_(bus, channels, kName, NewEpoch()),
      control_counter_(&status_, "REPLAY_CONTROL"),
      sender_(bus, channels, &recording_, &status_),
      announcer_(bus, channels, &sender_),
      window_(options.wait_for, WindowSize(bus->granted_receive_buffer()), options.resend_us),
      pacer_(options.speed.value_or(options.lossless ? 0.0 : 1.0)),
      paused_(options.start_paused) {
  if (!options.lossless && pacer_.speed() <= 0)
    throw std::runtime_error("speed 0 (unpaced) needs --lossless");
  if (options.lossless && options.wait_for.empty())
    throw std::runtime_error("--lossless needs a consumer: --wait-for");
  std::int64_t from = options.from_utime.value_or(recording_.begin_utime());
  end_ = recording_.size();
  if (options.seconds) {
    const auto [begin_s, end_s] = *options.seconds;
    from = recording_.begin_utime() + static_cast<std::int64_t>(begin_s * 1e6);
    end_ = recording_.FirstAt(recording_.begin_utime() + static_cast<std::int64_t>(end_s * 1e6));
  }
  begin_ = recording_.FirstAt(from);
  if (begin_ >= end_) {
    throw std::runtime_error(
        "nothing to replay: log " + options.log + " lasts from " + std::to_string(recording_.begin_utime()) +
        " to " + std::to_string(recording_.end_utime()) + " us, and the part asked for is not in it");
  }
  // For whoever wants to seek.
  status_.Counter("recording.begin_utime") = recording_.utime(begin_);
  status_.Counter("recording.end_utime") = recording_.utime(end_ - 1);
  bus->Subscribe(channels.replay_control, [this](const std::string&, const std::uint8_t* data,
                                                 std::size_t size) { OnControl(data, size); });
  if (options.lossless) {
    bus->Subscribe(channels.credit, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
      OnCredit(data, size);
    });
  }
  if (!options.position.empty()) {
    if (options.lossless) throw std::runtime_error("--position does not go with --lossless");
    // Another part of the same recording is another stream too.
    status_.Counter("continued") = 0;
    position_.emplace(options.position,
                      recording_.fingerprint() + static_cast<std::int64_t>(begin_ << 32 ^ end_));
    const std::optional<ReplayPosition> position = position_->Load();
    if (position && position->next >= static_cast<std::int64_t>(begin_) &&
        position->next <= static_cast<std::int64_t>(end_)) {
      Continue(*position);
      return;
    }
  }
  StartStream(begin_);
}

void LogReplay::Continue(const ReplayPosition& position) {
  sender_.Continue(position);
  next_ = static_cast<std::size_t>(position.next);
  paused_ = position.paused != 0;
  phase_ = position.ended != 0 ? Phase::kEnded : Phase::kSending;
  if (position.speed > 0) pacer_ = Pacer(position.speed);
  pacer_.Start(SteadyTime(), DataTime());
  ++status_.Counter("continued");
}

void LogReplay::StorePosition() {
  if (!position_) return;
  ReplayPosition position;
  position.next = static_cast<std::int64_t>(next_);
  position.ended = phase_ == Phase::kEnded ? 1 : 0;
  position.paused = paused_ ? 1 : 0;
  position.speed = pacer_.speed();
  sender_.Save(&position);
  position_->Store(position);
}

void LogReplay::StartStream(std::size_t position) {
  // Whoever listens tells by the epoch that what came before is stale.
  const std::int64_t epoch = NewEpoch();
  sender_.Restart(epoch);
  window_.Restart(epoch);
  announcer_.Restart();
  next_ = position;
  if (phase_ == Phase::kEnded) phase_ = Phase::kSending;
  pacer_.Start(SteadyTime(), DataTime());
  StorePosition();
}

std::int64_t LogReplay::DataTime() const { return recording_.utime(std::min(next_, end_ - 1)); }

void LogReplay::SetPaused(bool paused) {
  if (paused == paused_) return;
  paused_ = paused;
  if (!paused) pacer_.Start(SteadyTime(), DataTime());
  StorePosition();
  Report(SteadyTime());
}

void LogReplay::OnControl(const std::uint8_t* data, std::size_t size) {
  replay_control_t order;
  if (!DecodeChecked(data, size, &order)) {
    control_counter_.CountInvalid();
    return;
  }
  if (control_counter_.Commit(order.epoch, order.seq) == SequenceCounter::Verdict::kOld) return;
  switch (order.command) {
    case replay_control_t::PAUSE:
      SetPaused(true);
      break;
    case replay_control_t::RESUME:
      SetPaused(false);
      break;
    case replay_control_t::SEEK:
      StartStream(std::clamp(recording_.FirstAt(order.seek_utime), begin_, end_));
      break;
    default:  // SPEED: nothing else is valid
      if (order.speed <= 0 && !options_.lossless) {
        ++status_.Counter("REPLAY_CONTROL.refused");  // unpaced without flow control only loses
      } else {
        pacer_.SetSpeed(order.speed, SteadyTime(), DataTime());
      }
  }
}

void LogReplay::OnCredit(const std::uint8_t* data, std::size_t size) {
  credit_t credit;
  const bool valid = DecodeChecked(data, size, &credit);
  ++status_.Counter(valid ? "CREDIT.received" : "CREDIT.invalid");
  if (!valid) return;
  switch (window_.OnCredit(credit, SteadyTime())) {
    case SendWindow::Verdict::kTaken:
      break;
    case SendWindow::Verdict::kNotAwaited:
      ++status_.Counter("CREDIT.not_awaited");
      break;
    case SendWindow::Verdict::kImpossible:
      ++status_.Counter("CREDIT.invalid");
      break;
    case SendWindow::Verdict::kRestarted:
      // What the consumer had is gone with it; the best there is: a new stream from what was not consumed
      // yet.
      ++status_.Counter("CREDIT.restarts");
      StartStream(window_.first_unacknowledged(next_));
      break;
  }
}

void LogReplay::Tick() {
  const std::int64_t now_us = SteadyTime();
  if (phase_ == Phase::kWaiting && (!options_.lossless || window_.missing_consumers().empty())) {
    phase_ = Phase::kSending;
    pacer_.Start(now_us, DataTime());
    Report(now_us);
  }
  if (phase_ != Phase::kWaiting && !paused_) Send(now_us);
  if (phase_ == Phase::kEnded)
    announcer_.Tick(SteadyTime(), everything_delivered(), recording_.utime(end_ - 1));
  if (now_us - reported_us_ >= kReportPeriodUs) Report(now_us);
  status_.Tick();
}

void LogReplay::Send(std::int64_t now_us) {
  if (options_.lossless && window_.Stalled(now_us)) {
    window_.GoBack(now_us);
    ++status_.Counter("resend.rounds");
  }
  for (int i = 0; i < kBurst; ++i) {
    if (!SendOneAgain() && !SendOneNew(now_us)) break;
    now_us = SteadyTime();
  }
  if (phase_ == Phase::kSending && next_ == end_) {
    phase_ = Phase::kEnded;
    StorePosition();
    Report(now_us);
  }
}

bool LogReplay::SendOneAgain() {
  const SendWindow::Item* again = window_.NextAgain();
  if (again == nullptr || !window_.MaySend(again->bytes)) return false;
  sender_.SendAgain(again->source, again->seq);
  ++status_.Counter("resend.messages");
  window_.SentAgain();
  return true;
}

bool LogReplay::SendOneNew(std::int64_t now_us) {
  if (next_ == end_ || window_.NextAgain() != nullptr) return false;
  const std::int64_t wait_us = pacer_.Until(recording_.utime(next_), now_us);
  if (wait_us >= 1000) return false;  // Poll waits for whole milliseconds, this for the rest
  const std::int64_t bytes = recording_.bytes(next_) + kOverhead;
  if (options_.lossless && !window_.MaySend(bytes)) return false;
  if (wait_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
  const std::size_t i = next_++;
  const Recording::Kind kind = recording_.kind(i);
  const std::int64_t seq = sender_.sent(kind);
  const bool sent = sender_.SendNew(i);
  StorePosition();
  if (!sent || !options_.lossless || kind == Recording::kGroundTruth) return true;
  window_.Sent({static_cast<SendWindow::Stream>(kind), seq, bytes, i}, now_us);
  return true;
}

int LogReplay::poll_timeout_ms() const {
  constexpr int kLongest = 10;
  if (phase_ != Phase::kSending || paused_) return kLongest;
  const SendWindow::Item* again = window_.NextAgain();
  if (again != nullptr) return window_.MaySend(again->bytes) ? 0 : kLongest;
  if (next_ == end_) return kLongest;
  // Without room in the window only a credit helps, and that ends the wait by itself.
  if (options_.lossless && !window_.MaySend(recording_.bytes(next_) + kOverhead)) return kLongest;
  const std::int64_t wait_us = pacer_.Until(recording_.utime(next_), SteadyTime());
  return static_cast<int>(std::clamp<std::int64_t>(wait_us / 1000, 0, kLongest));
}

}  // namespace evit
