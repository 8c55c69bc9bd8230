// The part of WindowOptimizer that takes keyframes from the queue, has them processed and says what came of
// it.
#include <algorithm>
#include <utility>

#include "services/window_optimizer/merge_imu.h"
#include "services/window_optimizer/messages.h"
#include "services/window_optimizer/window_optimizer.h"

namespace evit {
namespace {

// Real time: the solver may take so long, and a share of the time between keyframes where that is more. Then
// the best so far counts.
constexpr double kLeastBudget = 0.015, kMostBudget = 0.1;  // s
constexpr double kBudgetShare = 0.6;
constexpr auto kMapIsDead = std::chrono::milliseconds(60);
constexpr auto kAnswerPatience = std::chrono::milliseconds(20);  // real time: go on with the points at hand

double Milliseconds(std::chrono::steady_clock::duration d) {
  return std::chrono::duration<double, std::milli>(d).count();
}

}  // namespace

bool WindowOptimizer::ReadyForNext() const {
  if (answered_) return true;
  // Without any answer yet there are no points at all: waiting is the only sensible thing.
  if (settings_.lossless || last_mode_.keyframe_seq < 0) return false;
  // Waiting again for a map_server that has died would cost keyframes.
  const auto now = Clock::now();
  return now - unanswered_since_ > kMapIsDead || now - first_asked_ > kAnswerPatience;
}

void WindowOptimizer::ProcessQueue() {
  while (true) {
    if (work_ && !FinishWork(false)) return;
    if (queue_.empty() || !ReadyForNext()) return;
    if (checkpoint_ && Resumed()) return;  // its points first
    DropSuperseded();
    Waiting next = std::move(queue_.front());
    queue_.pop_front();
    StartWork(std::move(next));
    if (settings_.lossless) FinishWork(true);
  }
}

// Once tracking, the high-rate frames that queued up meanwhile tell nothing that the newest does not.
void WindowOptimizer::DropSuperseded() {
  while (!settings_.lossless && tracker_.mode() == TrackerMode::kTracking && queue_.size() > 1 &&
         queue_.front().message.high_rate != 0) {
    MergeImu(queue_.front().message, &queue_[1].message);
    queue_.pop_front();
    ++status_.Counter("KEYFRAME.superseded");
  }
}

void WindowOptimizer::StartWork(Waiting next) {
  const bool tracking = tracker_.mode() == TrackerMode::kTracking;
  const bool late_by_restart = next.message.seq <= caught_up_;
  if (!settings_.lossless && tracking && !late_by_restart) Govern(Milliseconds(Clock::now() - next.arrived));
  if (!settings_.lossless) {
    const double interval = 1e-3 * Milliseconds(next.arrived - last_arrived_);
    tracker_.set_solve_budget(queue_.empty() ? std::clamp(kBudgetShare * interval, kLeastBudget, kMostBudget)
                                             : kLeastBudget);
    last_arrived_ = next.arrived;
  }
  KeyframeInput input = FromMessage(next.message);
  if (tracker_.state_time() != 0 && next.message.previous_utime != tracker_.state_time()) {
    // A keyframe between was lost, or frame_builder started anew: the IMU samples since are our own.
    input.imu = imu_.Between(tracker_.state_time(), input.t);
    input.imu_gap = ImuHistory::LongestGap(input.imu);
    ++status_.Counter("KEYFRAME.bridged");
  }
  if (settings_.lossless && tracking) {
    // Deterministic: the poses of this interval come from the state before it, as they would have live.
    PublishPoses(input.imu, {tracker_.state().T_map_body, tracker_.state().velocity}, tracker_.state().bias);
  }
  if (tracking) AskForPoints(tracker_.QueryAfter(input));
  work_.emplace();
  work_->keyframe = std::move(next.message);
  work_->arrived = next.arrived;
  work_->asked = tracking;
  // In a thread of its own in real time: an IMU sample that comes meanwhile has its pose at once. Until it is
  // done nothing else touches the tracker.
  const auto policy = settings_.lossless ? std::launch::deferred : std::launch::async;
  work_->result = std::async(policy, [this, input = std::move(input)] {
    const auto begin = Clock::now();
    TrackerOutput output = tracker_.Process(input);
    return std::make_pair(std::move(output), Milliseconds(Clock::now() - begin));
  });
}

bool WindowOptimizer::FinishWork(bool wait) {
  if (!wait && work_->result.wait_for(std::chrono::seconds(0)) == std::future_status::timeout) return false;
  const auto [output, solve_ms] = work_->result.get();
  Report(output, work_->keyframe, solve_ms, work_->arrived);
  const bool ask = !work_->asked || output.mode != TrackerMode::kTracking;
  work_.reset();
  if (ask) AskForPoints(tracker_.NextQuery());
  if (answer_ && !ask) tracker_.AddVisible(answer_->id, PointsOf(*answer_));
  answer_.reset();
  TakeHint();
  return true;
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
  if (checkpoint_file_ && output.has_pose) {
    checkpoint_file_->Store({keyframe.utime, keyframe.epoch, keyframe.seq, state, output.information,
                             tracker_.rate(), output.image_speed});
  }
  if (!settings_.lossless && output.mode == TrackerMode::kTracking) {
    live_ = {state.T_map_body, state.velocity};
    live_bias_ = state.bias;
    live_time_ = keyframe.utime;
  } else {
    live_time_ = 0;
  }
  static constexpr const char* kModes[] = {"bootstrapping", "tracking", "lost"};
  ++status_.Counter(std::string("mode.") + kModes[static_cast<int>(output.mode)]);
  status_.SetState("running", std::string(kModes[static_cast<int>(output.mode)]) + ": " + output.reason);
}

}  // namespace evit
