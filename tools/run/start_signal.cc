#include "tools/run/start_signal.h"

namespace evit::run {

void StartSignal::Tick(const Recorder& recorder) {
  for (const char* name : {"map_server", "window_optimizer", "frame_builder", "log_replay"}) {
    if (recorder.statuses().count(name) == 0) return;
  }
  if (recorder.statuses().at("log_replay").state != "paused") return;
  const Clock::time_point now = Clock::now();
  if (sent_ && now - sent_at_ < std::chrono::milliseconds(500)) return;
  remote_->Resume();
  sent_ = true;
  sent_at_ = now;
}

}  // namespace evit::run
