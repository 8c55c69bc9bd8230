#include "services/window_optimizer/photometric_optimizer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/bus/subscribe.h"
#include "common/time/milliseconds.h"
#include "common/wire/view_wire.h"

namespace evit {
namespace {

// Real time: then the tracker continues with the view at hand.
constexpr RequestClient<MapViewRequest>::Patience kViewPatience{std::chrono::milliseconds(50)};

constexpr std::size_t kMaxQueue = 2;  // keyframes waiting, real time

PhotometricFrame FrameOf(const keyframe_t& m) {
  PhotometricFrame f;
  f.t = m.utime;
  f.seq = m.seq;
  f.n_events = m.n_events;
  f.begin = m.from_utime;
  f.end = m.utime + m.lookahead_us;
  f.counts = cv::Mat(m.height, m.width, CV_8UC1);
  std::copy(m.surface.begin(), m.surface.end(), f.counts.data);
  return f;
}

}  // namespace

PhotometricOptimizer::PhotometricOptimizer(Bus* bus, const Channels& channels, const Settings& settings)
    : lossless_(settings.lossless),
      status_(bus, channels, "window_optimizer", NewEpoch()),
      keyframe_inbox_(&status_, keyframe_t::EVENT_COUNT, settings.rig.camera),
      queue_(&status_, {settings.lossless, kMaxQueue, kMaxQueue, false}),
      hints_(&status_),
      map_(bus, channels, &status_, kViewPatience, Clock::now()),
      publisher_(bus, channels, &status_),
      tracker_(settings.rig, settings.tracker, settings.T_map_body) {
  Subscribe(bus, channels.keyframe, this, &PhotometricOptimizer::OnKeyframe);
  Subscribe(bus, channels.map_view, this, &PhotometricOptimizer::OnView);
  Subscribe(bus, channels.pose_hint, this, &PhotometricOptimizer::OnPoseHint);
  status_.SetState("waiting", "waiting for map_server and for keyframes");
  AskForView();
}

void PhotometricOptimizer::AskForView() {
  asked_view_ = tracker_.NextQuery();
  view_query_t message = ToMessage(asked_view_);
  message.utime = tracker_.state_time();
  map_.Ask(message, Clock::now());
}

void PhotometricOptimizer::OnView(const std::uint8_t* data, std::size_t size) {
  if (!map_.OnAnswer(data, size, Clock::now())) return;
  tracker_.SetView(FromMessage(*map_.TakeAnswer(), asked_view_));
  ProcessNext();
}

void PhotometricOptimizer::OnKeyframe(const std::uint8_t* data, std::size_t size) {
  std::optional<keyframe_t> keyframe = keyframe_inbox_.Decode(data, size);
  if (!keyframe) return;
  const KeyframeQueue::Admission admission = queue_.Admit(std::move(*keyframe), Clock::now());
  if (admission == KeyframeQueue::Admission::kQueued) ProcessNext();
  if (admission == KeyframeQueue::Admission::kOld) publisher_.PublishModeAgain();
}

void PhotometricOptimizer::OnPoseHint(const std::uint8_t* data, std::size_t size) {
  hints_.OnMessage(data, size);
  const std::optional<SE3> T_map_body = hints_.Take();
  if (!T_map_body) return;
  tracker_.Start(*T_map_body);
  AskForView();
}

bool PhotometricOptimizer::ReadyForNext() const {
  if (map_.answered()) return true;
  // Without any view yet waiting is the only sensible thing.
  return !lossless_ && publisher_.has_answered() && map_.GivenUp(Clock::now());
}

void PhotometricOptimizer::ProcessNext() {
  if (queue_.empty() || !ReadyForNext()) return;
  ProcessedKeyframe processed;
  processed.keyframe = queue_.Pop();
  const auto begin = Clock::now();
  processed.output = tracker_.Process(FrameOf(processed.keyframe.message));
  processed.solve_ms = Milliseconds(Clock::now() - begin);
  // The answer is on the way while this one is reported. One that is still awaited is not given up: where
  // views take longer than frames there would never be any.
  if (map_.answered()) AskForView();
  Report(processed);
}

void PhotometricOptimizer::Report(const ProcessedKeyframe& processed) {
  const BodyState& state = tracker_.state();
  publisher_.PublishWindow(processed);
  if (processed.output.has_pose)
    publisher_.PublishPose(processed.keyframe.message.utime, {state.T_map_body, state.velocity});
  publisher_.PublishMode(processed, 1);
}

void PhotometricOptimizer::Tick() {
  map_.Tick(Clock::now());
  ProcessNext();
  if (map_.ServerTimedOut(Clock::now())) {
    status_.SetState(
        "waiting",
        "map_server does not answer: is it running with --photometric-map, on the same URL and prefix?");
  }
  status_.Tick();
}

}  // namespace evit
