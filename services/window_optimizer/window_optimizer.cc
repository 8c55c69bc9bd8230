#include "services/window_optimizer/window_optimizer.h"

#include <memory>
#include <optional>
#include <utility>

#include "common/bus/subscribe.h"
#include "common/imu/preintegration.h"
#include "common/wire/tracker_wire.h"

namespace evit {
namespace {

std::unique_ptr<MapTracker> TrackerFor(const WindowOptimizer::Settings& settings) {
  std::unique_ptr<MapTracker> tracker = MakeTracker(settings.rig, settings.tracker, settings.T_map_body);
  if (!settings.locate) return tracker;
  return std::make_unique<LocatingTracker>(std::move(tracker), settings.rig, settings.tracker,
                                           *settings.locate);
}

}  // namespace

WindowOptimizer::WindowOptimizer(Bus* bus, const Channels& channels, const Settings& settings)
    : settings_(settings),
      status_(bus, channels, "window_optimizer", NewEpoch()),
      keyframe_inbox_(&status_, keyframe_t::TIME_SURFACE, settings.rig.camera),
      queue_(&status_, {settings.lossless}),
      imu_(&status_),
      imu_rate_pose_(settings.rig.gravity),
      hints_(&status_),
      map_(bus, channels, &status_, Clock::now()),
      places_(bus, channels, &status_, settings.rig, Clock::now()),
      load_(&status_),
      restart_(settings.lossless ? "" : settings.checkpoint),
      publisher_(bus, channels, &status_),
      worker_(TrackerFor(settings), settings.lossless ? TrackerWorker::Threading::kCallersThread
                                                      : TrackerWorker::Threading::kOwnThread) {
  Subscribe(bus, channels.keyframe, this, &WindowOptimizer::OnKeyframe);
  Subscribe(bus, channels.map_points, this, &WindowOptimizer::OnMapPoints);
  Subscribe(bus, channels.places, this, &WindowOptimizer::OnPlaces);
  Subscribe(bus, channels.imu, this, &WindowOptimizer::OnImu);
  Subscribe(bus, channels.pose_hint, this, &WindowOptimizer::OnPoseHint);
  status_.SetState("waiting", "waiting for map_server and for keyframes");
  if (restart_.checkpoint()) {
    worker_.idle_tracker()->Start(restart_.checkpoint()->state);
    publisher_.PublishAnnouncement(restart_.Announce(Clock::now()));
  }
  AskForPoints();
}

void WindowOptimizer::OnKeyframe(const std::uint8_t* data, std::size_t size) {
  std::optional<keyframe_t> keyframe = keyframe_inbox_.Decode(data, size);
  if (!keyframe) return;
  if (restart_.collecting()) {
    restart_.Collect(std::move(*keyframe), Clock::now());
    CatchUp();
    return;
  }
  const KeyframeQueue::Admission admission = queue_.Admit(std::move(*keyframe), Clock::now());
  if (admission == KeyframeQueue::Admission::kQueued) ProcessQueue();
  if (admission == KeyframeQueue::Admission::kOld) publisher_.PublishModeAgain();
}

void WindowOptimizer::OnMapPoints(const std::uint8_t* data, std::size_t size) {
  if (!map_.OnAnswer(data, size, Clock::now())) return;
  UsePoints();
  ProcessQueue();
}

void WindowOptimizer::OnPlaces(const std::uint8_t* data, std::size_t size) {
  if (!places_.OnAnswer(data, size, Clock::now())) return;
  if (worker_.idle_tracker() != nullptr) places_.Serve(worker_.idle_tracker(), Clock::now());
  ProcessQueue();
}

void WindowOptimizer::OnImu(const std::uint8_t* data, std::size_t size) {
  for (const ImuSample& sample : imu_.OnMessage(data, size)) {
    const std::optional<NavState> state = imu_rate_pose_.At(sample.t, imu_.history());
    if (state) publisher_.PublishPose(sample.t, *state);
  }
}

void WindowOptimizer::OnPoseHint(const std::uint8_t* data, std::size_t size) {
  hints_.OnMessage(data, size);
  UseHint();
}

void WindowOptimizer::ProcessQueue() {
  while (true) {
    if (worker_.working() && !FinishWork(TrackerWorker::Wait::kNo)) return;
    if (queue_.empty() || !ReadyForNext()) return;
    if (restart_.checkpoint()) {
      StartFromCheckpoint();
      return;  // its points first
    }
    // While tracking, the high-rate frames that queued up tell nothing that the newest does not.
    if (worker_.idle_tracker()->mode() == TrackerMode::kTracking) queue_.DropSuperseded();
    StartWork(queue_.Pop());
    if (settings_.lossless) FinishWork(TrackerWorker::Wait::kYes);
  }
}

bool WindowOptimizer::ReadyForNext() const {
  if (settings_.lossless && places_.waiting()) return false;
  if (map_.answered()) return true;
  // Without any answer yet there are no points at all: waiting is the only sensible thing.
  return !settings_.lossless && publisher_.has_answered() && map_.GivenUp(Clock::now());
}

void WindowOptimizer::StartWork(QueuedKeyframe next) {
  MapTracker* const tracker = worker_.idle_tracker();
  const bool tracking = tracker->mode() == TrackerMode::kTracking;
  if (!settings_.lossless) LimitWork(next, tracking);
  KeyframeInput input = InputOf(next.message);
  if (settings_.lossless && tracking) PublishPoses(input.imu, tracker->state());
  if (tracking) map_.AskAhead(*tracker, input, Clock::now());
  asked_ahead_ = tracking;
  worker_.Start(std::move(next), std::move(input));
}

void WindowOptimizer::LimitWork(const QueuedKeyframe& next, bool tracking) {
  const bool shows_load = tracking && !queue_.LateByRestart(next.message);
  const LoadLimiter::Limits limits = load_.Begin(next, shows_load, !queue_.empty(), Clock::now());
  worker_.idle_tracker()->set_point_share(limits.point_share);
  worker_.idle_tracker()->set_solve_budget(limits.solve_budget);
}

KeyframeInput WindowOptimizer::InputOf(const keyframe_t& keyframe) {
  KeyframeInput input = FromMessage(keyframe);
  const Utime state_time = worker_.idle_tracker()->state_time();
  if (state_time != 0 && keyframe.previous_utime != state_time) {
    // A keyframe between was lost, or frame_builder was restarted: the IMU samples since are our own.
    input.imu = imu_.history().Between(state_time, input.t);
    input.imu_gap = ImuHistory::LongestGap(input.imu);
    if (!input.imu.empty()) ++status_.Counter("KEYFRAME.bridged");
  }
  return input;
}

bool WindowOptimizer::FinishWork(TrackerWorker::Wait wait) {
  const std::optional<ProcessedKeyframe> processed = worker_.Finish(wait);
  if (!processed) return false;
  Report(*processed);
  const bool tracking = processed->output.mode == TrackerMode::kTracking;
  if (!asked_ahead_ || !tracking) AskForPoints();
  UsePoints();
  UseHint();
  places_.Serve(worker_.idle_tracker(), Clock::now());
  return true;
}

void WindowOptimizer::Report(const ProcessedKeyframe& processed) {
  const MapTracker& tracker = *worker_.idle_tracker();
  const keyframe_t& keyframe = processed.keyframe.message;
  const TrackerOutput& output = processed.output;
  publisher_.PublishWindow(processed);
  publisher_.PublishMode(processed, load_.keyframe_stride());
  PublishKeyframePose(processed);
  if (restart_.enabled() && output.has_pose) {
    restart_.Store({keyframe.utime, keyframe.epoch, keyframe.seq, tracker.state(), output.information,
                    tracker.rate(), output.image_speed});
  }
  if (!settings_.lossless && output.mode == TrackerMode::kTracking) {
    imu_rate_pose_.StartFrom(keyframe.utime, tracker.state());
  } else {
    imu_rate_pose_.Stop();
  }
}

// Lossless, hence deterministic: the poses of an interval come from the state before it, as they would have
// live.
void WindowOptimizer::PublishPoses(const std::vector<ImuSample>& samples, const BodyState& from) {
  NavState state{from.T_map_body, from.velocity};
  for (std::size_t k = 1; k < samples.size(); ++k) {
    state = PropagateImu(state, {samples[k - 1], samples[k]}, from.bias, settings_.rig.gravity);
    publisher_.PublishPose(samples[k].t, state);
  }
}

// Where there is no IMU to give poses at its rate.
void WindowOptimizer::PublishKeyframePose(const ProcessedKeyframe& processed) {
  const keyframe_t& keyframe = processed.keyframe.message;
  const bool begins = keyframe.previous_utime == keyframe.utime;  // no samples either, with an IMU
  if (keyframe.n_imu > 0 || begins || !processed.output.has_pose ||
      processed.output.mode != TrackerMode::kTracking)
    return;
  const BodyState& state = worker_.idle_tracker()->state();
  publisher_.PublishPose(keyframe.utime, {state.T_map_body, state.velocity});
}

void WindowOptimizer::AskForPoints() { map_.Ask(*worker_.idle_tracker(), Clock::now()); }

// Those that come while a keyframe is in work are for the one after it.
void WindowOptimizer::UsePoints() {
  if (worker_.idle_tracker() != nullptr) map_.Serve(worker_.idle_tracker());
}

void WindowOptimizer::UseHint() {
  MapTracker* const tracker = worker_.idle_tracker();
  if (tracker == nullptr) return;
  const std::optional<SE3> T_map_body = hints_.Take();
  if (!T_map_body) return;
  tracker->Start(*T_map_body);
  restart_.Done();
  imu_rate_pose_.Stop();
  AskForPoints();
}

// Nothing is in work before all keyframes since the checkpoint are here.
void WindowOptimizer::CatchUp() {
  const auto now = Clock::now();
  const KeyframeCatchUp::Progress progress = restart_.ProgressAt(now);
  if (progress == KeyframeCatchUp::Progress::kWaiting) {
    if (restart_.AnnouncementDue(now)) publisher_.PublishAnnouncement(restart_.Announce(now));
    return;
  }
  std::vector<keyframe_t> keyframes = restart_.TakeKeyframes();
  if (progress == KeyframeCatchUp::Progress::kWhole) {
    const Checkpoint& checkpoint = *restart_.checkpoint();
    if (checkpoint.tracking())
      worker_.idle_tracker()->Start(checkpoint.t, checkpoint.state, checkpoint.information);
    restart_.Done();
    queue_.ExpectBurstUpTo(keyframes.back().seq);
    ++status_.Counter("checkpoint.resumed");
    status_.Counter("checkpoint.keyframes_again") += static_cast<std::int64_t>(keyframes.size());
  }
  queue_.AdmitCollected(std::move(keyframes), now);
  ProcessQueue();
}

// The keyframes since the checkpoint are gone: at the first one there is, the tracker starts where the body
// must be then.
void WindowOptimizer::StartFromCheckpoint() {
  BodyState initial;
  initial.T_map_body = settings_.T_map_body;
  const std::optional<BodyState> predicted = restart_.PredictedAt(queue_.front().message.utime);
  const bool searches = settings_.locate && settings_.locate->from_nothing;
  if (predicted || !searches) worker_.idle_tracker()->Start(predicted.value_or(initial));
  ++status_.Counter(predicted ? "checkpoint.used" : "checkpoint.stale");
  restart_.Done();
  AskForPoints();
}

void WindowOptimizer::Tick() {
  map_.Tick(Clock::now());
  places_.Tick(Clock::now());
  if (restart_.collecting()) CatchUp();
  ProcessQueue();
  if (map_.ServerTimedOut(Clock::now())) {
    status_.SetState("waiting", "map_server does not answer: is it running, on the same URL and prefix?");
  }
  status_.Counter("KEYFRAME.queued") = static_cast<std::int64_t>(queue_.size());
  status_.Tick();
}

void WindowOptimizer::Stop() {
  FinishWork(TrackerWorker::Wait::kYes);
  status_.SetState("finished", "stopped");
}

}  // namespace evit
