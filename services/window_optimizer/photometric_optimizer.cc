#include "services/window_optimizer/photometric_optimizer.h"

#include <utility>

#include "common/photometric/wire/view_wire.h"
#include "services/window_optimizer/messages.h"

namespace evit {
namespace {

constexpr std::size_t kMaxQueue = 2;                           // keyframes waiting, real time
constexpr auto kViewPatience = std::chrono::milliseconds(50);  // real time: go on with the view at hand
constexpr auto kAskAgain = std::chrono::milliseconds(200);     // an unanswered query is sent again

double Milliseconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}

PhotometricFrame FrameOf(const keyframe_t& m) {
  PhotometricFrame f;
  f.t = m.utime;
  f.seq = m.seq;
  f.n_events = m.n_events;
  f.begin = m.from_utime;
  f.end = m.utime + m.lookahead_us;
  f.counts = cv::Mat(m.height, m.width, CV_8UC1);
  std::copy(m.surface[0].begin(), m.surface[0].end(), f.counts.data);
  return f;
}

}  // namespace

PhotometricOptimizer::PhotometricOptimizer(Bus* bus, const Channels& channels, const Settings& settings)
    : bus_(bus),
      channels_(channels),
      settings_(settings),
      status_(bus, channels, "window_optimizer", NewEpoch()),
      keyframes_(&status_, "KEYFRAME"),
      pose_hints_(&status_, "POSE_HINT"),
      tracker_(settings.rig, settings.tracker, settings.T_map_body) {
  const auto on = [&](const std::string& channel, auto method) {
    bus_->Subscribe(channel, [this, method](const std::string&, const std::uint8_t* data, std::size_t size) {
      (this->*method)(data, size);
    });
  };
  on(channels_.keyframe, &PhotometricOptimizer::OnKeyframe);
  on(channels_.map_view, &PhotometricOptimizer::OnView);
  on(channels_.pose_hint, &PhotometricOptimizer::OnPoseHint);
  last_mode_.keyframe_seq = -1;
  last_mode_.keyframe_stride = 1;
  status_.SetState("waiting", "waiting for map_server and for keyframes");
  AskForView();
}

void PhotometricOptimizer::AskForView() {
  asked_view_ = tracker_.NextQuery();
  query_ = ToMessage(asked_view_);
  query_.utime = tracker_.state_time();
  answered_ = false;
  first_asked_ = asked_ = Clock::now();
  Send(channels_.view_query, &query_, &query_seq_);
}

void PhotometricOptimizer::OnView(const std::uint8_t* data, std::size_t size) {
  map_view_t message;
  if (!DecodeChecked(data, size, &message)) {
    ++status_.Counter("MAP_VIEW.invalid");
    return;
  }
  ++status_.Counter("MAP_VIEW.received");
  if (answered_ || message.query_epoch != query_.epoch || message.query_seq != query_.seq) return;
  if (message.width != query_.camera.width || message.height != query_.camera.height) {
    ++status_.Counter("MAP_VIEW.invalid");
    return;
  }
  answered_ = true;
  status_.AddTiming("map_answer", Milliseconds(Clock::now() - first_asked_));
  tracker_.SetView(FromMessage(message, asked_view_));
  ProcessQueue();
}

void PhotometricOptimizer::OnKeyframe(const std::uint8_t* data, std::size_t size) {
  keyframe_t message;
  if (!DecodeChecked(data, size, &message)) {
    keyframes_.CountInvalid();
    return;
  }
  if (!Usable(message)) return;
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
  while (!settings_.lossless && queue_.size() >= kMaxQueue) {
    queue_.pop_front();
    ++status_.Counter("KEYFRAME.dropped");
  }
  queue_.push_back({std::move(message), Clock::now()});
  ProcessQueue();
}

bool PhotometricOptimizer::Usable(const keyframe_t& message) {
  const Camera& camera = settings_.rig.camera;
  std::string wrong;
  if (message.width != camera.width || message.height != camera.height) {
    wrong = "keyframes are " + std::to_string(message.width) + "x" + std::to_string(message.height) +
            " but the rig file's camera is not: start frame_builder and window_optimizer with the same --rig";
  } else if (message.encoding != keyframe_t::EVENT_COUNT) {
    wrong =
        "keyframes hold time surfaces, EVPT needs event counts: start frame_builder with the same --config";
  }
  if (wrong.empty()) return true;
  keyframes_.CountInvalid();
  status_.SetState("failed", wrong);
  return false;
}

// As WindowOptimizer has it: a new sender starts with number 0; where this service is the newer one, what the
// sender sends twice is the oldest it has no answer for.
bool PhotometricOptimizer::InOrder(SequenceCounter::Verdict verdict, const keyframe_t& message) {
  if (verdict == SequenceCounter::Verdict::kGap) return false;
  if (verdict != SequenceCounter::Verdict::kNewEpoch || message.seq == 0) return true;
  const std::pair<std::int64_t, std::int64_t> number(message.epoch, message.seq);
  if (refused_ == number) return true;
  refused_ = number;
  return false;
}

void PhotometricOptimizer::OnPoseHint(const std::uint8_t* data, std::size_t size) {
  body_pose_t message;
  if (!DecodeChecked(data, size, &message)) {
    pose_hints_.CountInvalid();
    return;
  }
  if (pose_hints_.Accept(message.epoch, message.seq) == SequenceCounter::Verdict::kOld) return;
  const double* q = message.orientation;
  tracker_.StartAnew(
      {Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized(), Eigen::Vector3d(message.position)});
  AskForView();
}

bool PhotometricOptimizer::ReadyForNext() const {
  if (answered_) return true;
  // Without any view yet waiting is the only sensible thing.
  return !settings_.lossless && last_mode_.keyframe_seq >= 0 && Clock::now() - first_asked_ > kViewPatience;
}

void PhotometricOptimizer::ProcessQueue() {
  if (queue_.empty() || !ReadyForNext()) return;
  const Waiting next = std::move(queue_.front());
  queue_.pop_front();
  const auto begin = Clock::now();
  const TrackerOutput output = tracker_.Process(FrameOf(next.message));
  const double solve_ms = Milliseconds(Clock::now() - begin);
  // The answer is on the way while this one is reported. One that is still awaited is not given up: where
  // views take longer than frames there would never be any.
  if (answered_) AskForView();
  Report(output, next, solve_ms);
}

void PhotometricOptimizer::Report(const TrackerOutput& output, const Waiting& keyframe, double solve_ms) {
  const keyframe_t& message = keyframe.message;
  status_.AddTiming("solve", solve_ms);
  if (output.has_pose) {
    window_state_t window = ToWindowState(output);
    window.lookahead_us = message.lookahead_us;
    window.solve_ms = solve_ms;
    window.total_ms = Milliseconds(Clock::now() - keyframe.arrived);
    status_.AddTiming("keyframe", window.total_ms);
    Send(channels_.window_state, &window, &window_seq_);
    body_pose_t pose = ToBodyPose(message.utime, {tracker_.state().T_map_body, tracker_.state().velocity});
    Send(channels_.body_pose, &pose, &pose_seq_);
  }
  last_mode_ = ToTrackerMode(output, tracker_.state(), message.utime, message.seq);
  last_mode_.keyframe_epoch = message.epoch;
  Send(channels_.tracker_mode, &last_mode_, &mode_seq_);
  static constexpr const char* kModes[] = {"bootstrapping", "tracking", "lost"};
  ++status_.Counter(std::string("mode.") + kModes[static_cast<int>(output.mode)]);
  status_.SetState("running", std::string(kModes[static_cast<int>(output.mode)]) + ": " + output.reason);
}

void PhotometricOptimizer::Tick() {
  if (!answered_ && Clock::now() - asked_ > kAskAgain) {
    ++status_.Counter("VIEW_QUERY.sent_again");
    EncodeTo(query_, &buffer_);
    bus_->Publish(channels_.view_query, buffer_.data(), buffer_.size());
    asked_ = Clock::now();
  }
  ProcessQueue();
  if (!answered_ && Clock::now() - first_asked_ > std::chrono::seconds(2)) {
    status_.SetState(
        "waiting",
        "map_server does not answer: is it running with --photometric-map, on the same URL and prefix?");
  }
  status_.Tick();
}

}  // namespace evit
