#include "tools/run/start_signal.h"

namespace evit::run {

void StartSignal::Tick(const Recorder& recorder) {
  if (begun_) return;
  for (const char* name : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
    if (recorder.statuses().count(name) == 0) return;
  }
  const service_status_t& replay = recorder.statuses().at("log_replay");
  // A person may have paused it again before its first word.
  begun_ = replay.state != "paused" || replay.progress > 0;
  if (begun_) return;
  const Clock::time_point now = Clock::now();
  if (sent_ && now - sent_at_ < std::chrono::milliseconds(500)) return;
  remote_->Resume();
  sent_ = true;
  sent_at_ = now;
}

}  // namespace evit::run
