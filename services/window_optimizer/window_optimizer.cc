#include "services/window_optimizer/window_optimizer.h"

#include <utility>

#include "common/bus/codec.h"
#include "services/window_optimizer/merge_imu.h"
#include "services/window_optimizer/messages.h"

namespace evit {
namespace {

constexpr std::size_t kMaxQueue = 4;                        // keyframes waiting, real-time mode
constexpr std::size_t kMaxBootstrapQueue = 32;              // the same while bootstrapping
constexpr auto kAskAgain = std::chrono::milliseconds(200);  // an unanswered query is sent again

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
      pose_hints_(&status_, "POSE_HINT"),
      tracker_(settings.rig, settings.tracker, settings.T_map_body) {
  const auto on = [&](const std::string& channel, auto method) {
    bus_->Subscribe(channel, [this, method](const std::string&, const std::uint8_t* data, std::size_t size) {
      (this->*method)(data, size);
    });
  };
  on(channels_.keyframe, &WindowOptimizer::OnKeyframe);
  on(channels_.map_points, &WindowOptimizer::OnMapPoints);
  on(channels_.imu, &WindowOptimizer::OnImu);
  on(channels_.pose_hint, &WindowOptimizer::OnPoseHint);
  last_mode_.keyframe_seq = -1;
  last_mode_.keyframe_stride = 1;
  status_.SetState("waiting", "waiting for map_server and for keyframes");
  if (!settings.lossless && !settings.checkpoint.empty()) {
    checkpoint_file_.emplace(settings.checkpoint);
    checkpoint_ = checkpoint_file_->Load();
    if (checkpoint_) {
      tracker_.StartFrom(checkpoint_->state);
      catch_up_.emplace(checkpoint_->keyframe_epoch, checkpoint_->keyframe_seq);
      AnnounceCheckpoint();
    }
  }
  AskForPoints(tracker_.NextQuery());
}

void WindowOptimizer::AskForPoints(const VisibilityQuery& query) {
  query_ = ToMessage(query);
  query_.utime = tracker_.state_time();
  if (answered_) unanswered_since_ = Clock::now();
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
  unanswered_since_ = Clock::now();
  if (answered_ || message.query_epoch != query_.epoch || message.query_seq != query_.seq) return;
  answered_ = true;
  status_.AddTiming("map_answer", Milliseconds(Clock::now() - first_asked_));
  if (work_) {
    answer_ = std::move(message);  // for the keyframe after the one in work
  } else {
    tracker_.AddVisible(message.id, PointsOf(message));
  }
  ProcessQueue();
}

void WindowOptimizer::OnKeyframe(const std::uint8_t* data, std::size_t size) {
  keyframe_t message;
  if (!DecodeChecked(data, size, &message)) {
    keyframes_.CountInvalid();
    return;
  }
  if (message.encoding != keyframe_t::TIME_SURFACE) {
    keyframes_.CountInvalid();
    status_.SetState("failed",
                     "keyframes hold event counts, not time surfaces: start frame_builder and "
                     "window_optimizer with the same --config");
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
  if (catch_up_) {
    catch_up_->Add(std::move(message), Clock::now());
    CatchUp();
    return;
  }
  const auto verdict = keyframes_.Look(message.epoch, message.seq);
  if (settings_.lossless && !InOrder(verdict, message)) {
    ++status_.Counter("KEYFRAME.out_of_order");  // frame_builder sends the missing one again
    return;
  }
  keyframes_.Accept(message.epoch, message.seq);
  if (verdict == SequenceCounter::Verdict::kNewEpoch) caught_up_ = -1;
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
  // So may those since the last checkpoint.
  const bool patient =
      !queue_.empty() && (queue_.front().message.high_rate != 0 || queue_.front().message.seq <= caught_up_);
  const std::size_t longest = patient ? kMaxBootstrapQueue : kMaxQueue;
  while (!settings_.lossless && queue_.size() >= longest) {
    MergeImu(queue_.front().message, queue_.size() > 1 ? &queue_[1].message : &message);
    queue_.pop_front();
    ++status_.Counter("KEYFRAME.dropped");
  }
  queue_.push_back({std::move(message), Clock::now()});
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
    body_pose_t pose = ToBodyPose(sample.t, PropagateImu(live_, samples, live_bias_, settings_.rig.gravity));
    Send(channels_.body_pose, &pose, &pose_seq_);
  }
}

void WindowOptimizer::OnPoseHint(const std::uint8_t* data, std::size_t size) {
  body_pose_t message;
  if (!DecodeChecked(data, size, &message)) {
    pose_hints_.CountInvalid();
    return;
  }
  if (pose_hints_.Accept(message.epoch, message.seq) == SequenceCounter::Verdict::kOld) return;
  const double* q = message.orientation;
  hint_ = SE3{Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(), Eigen::Vector3d(message.position)};
  if (!work_) TakeHint();
}

void WindowOptimizer::TakeHint() {
  if (!hint_) return;
  tracker_.StartAnew(*hint_);
  hint_.reset();
  checkpoint_.reset();
  catch_up_.reset();
  live_time_ = 0;
  AskForPoints(tracker_.NextQuery());
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
  if (catch_up_) CatchUp();
  ProcessQueue();
  if (!answered_ && Clock::now() - first_asked_ > std::chrono::seconds(2)) {
    status_.SetState("waiting", "map_server does not answer: is it running, on the same URL and prefix?");
  }
  status_.Tick();
}

void WindowOptimizer::Stop() {
  if (work_) FinishWork(true);
  status_.SetState("finished", "stopped");
}

}  // namespace evit
