#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.h"
#include "common/bus/channels.h"
#include "common/service/mapped_file.h"
#include "common/service/runner.h"
#include "common/service/send_window.h"
#include "common/service/sequence_counter.h"
#include "common/service/status_reporter.h"
#include "services/log_replay/end_announcer.h"
#include "services/log_replay/pacer.h"
#include "services/log_replay/position.h"
#include "services/log_replay/recording.h"
#include "services/log_replay/stream_sender.h"

namespace evit {

struct LogReplayOptions {
  std::string log;
  std::string log_prefix;        // of the channel names in the log
  bool allow_truncated = false;  // replay the whole messages of a log that was cut off
  std::optional<double> speed;   // 1 real time; 0 (lossless only) unpaced. Default: 1, in lossless mode 0
  bool lossless = false;
  std::vector<std::string> wait_for = {"frame_builder"};  // consumers whose CREDIT counts in lossless mode
  bool start_paused = false;
  std::optional<std::int64_t> from_utime;            // us: start here
  std::optional<std::pair<double, double>> seconds;  // s after the log's first message: from, to
  bool exit_at_end = false;
  std::string position;  // file; real time only: a successor continues where this one died. Empty: none
  std::int64_t resend_us = 200'000;  // without progress for this long, what is under way is sent again
};

/// Replays a recording's EVENTS, IMU and GROUND_TRUTH, paced by data time, obeys REPLAY_CONTROL, and says
/// STREAM_END. Lossless: a bounded number of bytes beyond the slowest awaited consumer's CREDIT, and again
/// what got lost.
class LogReplay : public Service {
 public:
  /// `bus` must outlive this. Throws std::runtime_error where the log cannot be used (see Recording) or
  /// options disagree.
  LogReplay(const LogReplayOptions& options, Bus* bus, const Channels& channels);

  void Tick() override;
  bool done() const override;
  void Stop() override;
  int poll_timeout_ms() const override;

  const StatusReporter& status() const { return status_; }

 private:
  enum class Phase { kWaiting, kSending, kEnded };

  void OnControl(const std::uint8_t* data, std::size_t size);
  void OnCredit(const std::uint8_t* data, std::size_t size);
  void StartStream(std::size_t position);
  void Continue(const ReplayPosition& position);
  void StorePosition();
  void SetPaused(bool paused);
  void Send(std::int64_t now_us);
  bool SendOneAgain();
  bool SendOneNew(std::int64_t now_us);
  void Report(std::int64_t now_us);  // this, done() and Stop(): log_replay_report.cc
  std::int64_t DataTime() const;
  bool everything_delivered() const { return !options_.lossless || window_.all_acknowledged(); }

  LogReplayOptions options_;
  Recording recording_;
  StatusReporter status_;
  SequenceCounter control_counter_;
  StreamSender sender_;
  EndAnnouncer announcer_;
  SendWindow window_;
  Pacer pacer_;
  std::optional<MappedRecord<ReplayPosition>> position_;
  std::size_t begin_ = 0, end_ = 0;  // of the part that is replayed
  std::size_t next_ = 0;             // next new message
  Phase phase_ = Phase::kWaiting;
  bool paused_ = false;
  std::int64_t reported_us_ = 0;  // steady clock
};

}  // namespace evit
