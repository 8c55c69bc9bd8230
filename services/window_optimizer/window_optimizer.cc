#include "services/window_optimizer/window_optimizer.h"

#include <utility>

#include "common/bus/codec.h"
#include "services/window_optimizer/messages.h"

namespace evit {
namespace {

constexpr std::size_t kMaxQueue = 4;                             // keyframes waiting, real-time mode
constexpr std::size_t kMaxBootstrapQueue = 32;                   // the same while bootstrapping
constexpr double kSolveBudget = 0.015;                           // s, real time: then the best so far counts
constexpr auto kAskAgain = std::chrono::milliseconds(200);       // an unanswered query is sent again
constexpr auto kAnswerPatience = std::chrono::milliseconds(20);  // real time: go on with the points at hand

double Milliseconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}

}  // namespace

WindowOptimizer::WindowOptimizer(Bus* bus, const Channels& channels, const Settings& settings)
    : bus_(bus),
      channels_(channels),
      settings_(settings),
      status_(bus, channels, "window_optimizer", NewEpoch()),
      keyframes_(&status_, "KEYFRAME"),
      imu_messages_(&status_, "IMU"),
      tracker_(settings.rig, settings.tracker, settings.T_map_body) {
  const auto on = [&](const std::string& channel, auto method) {
    bus_->Subscribe(channel, [this, method](const std::string&, const std::uint8_t* data, std::size_t size) {
      (this->*method)(data, size);
    });
  };
  on(channels_.keyframe, &WindowOptimizer::OnKeyframe);
  on(channels_.map_points, &WindowOptimizer::OnMapPoints);
  on(channels_.imu, &WindowOptimizer::OnImu);
  last_mode_.keyframe_seq = -1;
  last_mode_.keyframe_stride = 1;
  if (!settings.lossless) tracker_.set_solve_budget(kSolveBudget);
  status_.SetState("waiting", "waiting for map_server and for keyframes");
  AskForPoints(tracker_.NextQuery());
}

template <typename Message>
void WindowOptimizer::Send(const std::string& channel, Message* message, std::int64_t* seq) {
  message->seq = (*seq)++;
  message->epoch = status_.epoch();
  EncodeTo(*message, &buffer_);
  bus_->Publish(channel, buffer_.data(), buffer_.size());
}

void WindowOptimizer::AskForPoints(const VisibilityQuery& query) {
  query_ = ToMessage(query);
  query_.utime = tracker_.state_time();
  answered_ = false;
  first_asked_ = asked_ = Clock::now();
  Send(channels_.map_query, &query_, &query_seq_);
}

// The very same query: its number tells which answer is awaited.
void WindowOptimizer::AskAgain() {
  ++status_.Counter("MAP_QUERY.sent_again");
  EncodeTo(query_, &buffer_);
  bus_->Publish(channels_.map_query, buffer_.data(), buffer_.size());
  asked_ = Clock::now();
}

void WindowOptimizer::OnMapPoints(const std::uint8_t* data, std::size_t size) {
  map_points_t message;
  if (!DecodeChecked(data, size, &message)) {
    ++status_.Counter("MAP_POINTS.invalid");
    return;
  }
  ++status_.Counter("MAP_POINTS.received");
  if (answered_ || message.query_epoch != query_.epoch || message.query_seq != query_.seq) return;
  answered_ = true;
  status_.AddTiming("map_answer", Milliseconds(Clock::now() - first_asked_));
  tracker_.AddVisible(message.id, PointsOf(message));
  ProcessQueue();
}

void WindowOptimizer::OnKeyframe(const std::uint8_t* data, std::size_t size) {
  keyframe_t message;
  if (!DecodeChecked(data, size, &message)) {
    keyframes_.CountInvalid();
    return;
  }
  if (message.width != settings_.rig.camera.width || message.height != settings_.rig.camera.height) {
    keyframes_.CountInvalid();
    status_.SetState("failed",
                     "keyframes are " + std::to_string(message.width) + "x" + std::to_string(message.height) +
                         " but the rig file's camera is not: start frame_builder and window_optimizer with "
                         "the same --rig");
    return;
  }
  const auto verdict = keyframes_.Look(message.epoch, message.seq);
  if (settings_.lossless && !InOrder(verdict, message)) {
    ++status_.Counter("KEYFRAME.out_of_order");  // frame_builder sends the missing one again
    return;
  }
  keyframes_.Accept(message.epoch, message.seq);
  if (verdict == SequenceCounter::Verdict::kOld) {
    // Sent again because our answer got lost: answer again.
    if (last_mode_.keyframe_seq >= 0) Send(channels_.tracker_mode, &last_mode_, &mode_seq_);
    return;
  }
  Queue(std::move(message));
  ProcessQueue();
}

// Lossless: whether this is the keyframe to take next. A new sender starts with number 0; where this service
// itself is the newer one, the sender is further on, and what it sends twice is the oldest it still has no
// answer for.
bool WindowOptimizer::InOrder(SequenceCounter::Verdict verdict, const keyframe_t& message) {
  if (verdict == SequenceCounter::Verdict::kGap) return false;
  if (verdict != SequenceCounter::Verdict::kNewEpoch || message.seq == 0) return true;
  const std::pair<std::int64_t, std::int64_t> number(message.epoch, message.seq);
  if (refused_ == number) return true;
  refused_ = number;
  return false;
}

void WindowOptimizer::Queue(keyframe_t message) {
  // High-rate frames may wait: they come in a burst at the start, and bootstrapping needs each.
  const bool high_rate = !queue_.empty() && queue_.front().message.high_rate != 0;
  const std::size_t longest = high_rate ? kMaxBootstrapQueue : kMaxQueue;
  while (!settings_.lossless && queue_.size() >= longest) {
    queue_.pop_front();
    ++status_.Counter("KEYFRAME.dropped");
  }
  queue_.push_back({std::move(message), Clock::now()});
}

bool WindowOptimizer::ReadyForNext() const {
  if (answered_) return true;
  // Without any answer yet there are no points at all: waiting is the only sensible thing.
  return !settings_.lossless && last_mode_.keyframe_seq >= 0 && Clock::now() - first_asked_ > kAnswerPatience;
}

void WindowOptimizer::ProcessQueue() {
  while (!queue_.empty() && ReadyForNext()) {
    // Once tracking, the high-rate frames that queued up meanwhile tell nothing that the newest does not.
    while (!settings_.lossless && tracker_.mode() == TrackerMode::kTracking && queue_.size() > 1 &&
           queue_.front().message.high_rate != 0) {
      queue_.pop_front();
      ++status_.Counter("KEYFRAME.superseded");
    }
    const Waiting next = std::move(queue_.front());
    queue_.pop_front();
    const auto begin = Clock::now();
    if (!settings_.lossless && tracker_.mode() == TrackerMode::kTracking)
      Govern(Milliseconds(begin - next.arrived));
    KeyframeInput input = FromMessage(next.message);
    if (tracker_.state_time() != 0 && next.message.previous_utime != tracker_.state_time()) {
      // A keyframe between was lost, or frame_builder started anew: the IMU samples since are our own.
      input.imu = imu_.Between(tracker_.state_time(), input.t);
      input.imu_gap = ImuHistory::LongestGap(input.imu);
      ++status_.Counter("KEYFRAME.bridged");
    }
    if (settings_.lossless && tracker_.mode() == TrackerMode::kTracking) {
      // Deterministic: the poses of this interval come from the state before it, as they would have live.
      PublishPoses(input.imu, {tracker_.state().T_world_body, tracker_.state().velocity},
                   tracker_.state().bias);
    }
    const bool foreseeable = tracker_.mode() == TrackerMode::kTracking;
    if (foreseeable) AskForPoints(tracker_.QueryAfter(input));
    const auto solving = Clock::now();
    const TrackerOutput output = tracker_.Process(input);
    Report(output, next.message, Milliseconds(Clock::now() - solving), next.arrived);
    if (!foreseeable || output.mode != TrackerMode::kTracking) AskForPoints(tracker_.NextQuery());
  }
}

void WindowOptimizer::Govern(double waited_ms) {
  const int before = governor_.level();
  governor_.Observe(waited_ms);
  status_.AddTiming("wait", waited_ms);
  if (governor_.level() == before) return;
  tracker_.set_point_share(governor_.point_share());
  status_.Counter("overload.level") = governor_.level();
  if (governor_.level() > before) ++status_.Counter("overload.steps");
}

void WindowOptimizer::Report(const TrackerOutput& output, const keyframe_t& keyframe, double solve_ms,
                             Clock::time_point arrived) {
  const BodyState& state = tracker_.state();
  status_.AddTiming("solve", solve_ms);
  if (output.has_pose) {
    window_state_t window = ToWindowState(output);
    window.lookahead_us = keyframe.lookahead_us;
    window.solve_ms = solve_ms;
    window.total_ms = Milliseconds(Clock::now() - arrived);
    status_.AddTiming("keyframe", window.total_ms);
    Send(channels_.window_state, &window, &window_seq_);
  }
  last_mode_ = ToTrackerMode(output, state, keyframe.utime, keyframe.seq);
  last_mode_.keyframe_epoch = keyframe.epoch;
  last_mode_.keyframe_stride = governor_.keyframe_stride();
  Send(channels_.tracker_mode, &last_mode_, &mode_seq_);
  if (!settings_.lossless && output.mode == TrackerMode::kTracking) {
    live_ = {state.T_world_body, state.velocity};
    live_time_ = keyframe.utime;
  } else {
    live_time_ = 0;
  }
  static constexpr const char* kModes[] = {"bootstrapping", "tracking", "lost"};
  ++status_.Counter(std::string("mode.") + kModes[static_cast<int>(output.mode)]);
  status_.SetState("running", std::string(kModes[static_cast<int>(output.mode)]) + ": " + output.reason);
}

void WindowOptimizer::OnImu(const std::uint8_t* data, std::size_t size) {
  imu_batch_t message;
  if (!DecodeChecked(data, size, &message)) {
    imu_messages_.CountInvalid();
    return;
  }
  if (imu_messages_.Accept(message.epoch, message.seq) == SequenceCounter::Verdict::kNewEpoch) imu_.Clear();
  for (int i = 0; i < message.n; ++i) {
    const ImuSample sample{message.sample_utime[i], Eigen::Vector3d(message.gyro[i].data()),
                           Eigen::Vector3d(message.accel[i].data())};
    if (!imu_.Add(sample) || settings_.lossless || live_time_ == 0) continue;
    const std::vector<ImuSample> samples = imu_.Between(live_time_, sample.t);
    if (samples.empty()) continue;
    // From the newest keyframe, whose state may have come since: a few samples, and always the best estimate.
    body_pose_t pose =
        ToBodyPose(sample.t, PropagateImu(live_, samples, tracker_.state().bias, tracker_.gravity()));
    Send(channels_.body_pose, &pose, &pose_seq_);
  }
}

void WindowOptimizer::PublishPoses(const std::vector<ImuSample>& samples, NavState from,
                                   const ImuBias& bias) {
  for (std::size_t k = 1; k < samples.size(); ++k) {
    from = PropagateImu(from, {samples[k - 1], samples[k]}, bias, tracker_.gravity());
    body_pose_t pose = ToBodyPose(samples[k].t, from);
    Send(channels_.body_pose, &pose, &pose_seq_);
  }
}

void WindowOptimizer::Tick() {
  if (!answered_ && Clock::now() - asked_ > kAskAgain) AskAgain();
  ProcessQueue();
  if (!answered_ && Clock::now() - first_asked_ > std::chrono::seconds(2)) {
    status_.SetState("waiting", "map_server does not answer: is it running, on the same URL and prefix?");
  }
  status_.Tick();
}

void WindowOptimizer::Stop() { status_.SetState("finished", "stopped"); }

}  // namespace evit
