#include "tools/run/recorder.h"

#include <algorithm>

#include "common/bus/codec.h"
#include "common/wire/geometry_wire.h"

namespace evit::run {
namespace {

StampedPose StampedPoseOf(const node_state_t& node) { return {node.utime, PoseOf(node)}; }

Matrix6d CovarianceOf(const window_state_t& message) {
  Matrix6d covariance;
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) covariance(r, c) = message.covariance[r][c];
  }
  return covariance;
}

}  // namespace

Recorder::Recorder(Bus* bus, const Channels& channels) {
  mode_.keyframe_seq = -1;
  bus->Subscribe(channels.window_state,
                 [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                   window_state_t message;
                   if (DecodeChecked(data, size, &message)) OnWindow(message);
                 });
  bus->Subscribe(channels.tracker_mode,
                 [this](const std::string&, const std::uint8_t* data, std::size_t size) {
                   tracker_mode_t message;
                   if (DecodeChecked(data, size, &message)) OnMode(message);
                 });
  bus->Subscribe(channels.status, [this](const std::string&, const std::uint8_t* data, std::size_t size) {
    service_status_t message;
    if (DecodeChecked(data, size, &message)) OnStatus(message);
  });
}

void Recorder::OnStatus(const service_status_t& message) {
  const auto before = statuses_.find(message.service);
  if (before != statuses_.end() && before->second.epoch != message.epoch) {
    // A last word of one that was restarted may come late; two at work speak in turn.
    if (epochs_[message.service].count(message.epoch) > 0 && ++turns_ >= 3) two_senders_ = message.service;
    epochs_[message.service].insert(before->second.epoch);
  }
  statuses_[message.service] = message;
}

void Recorder::OnWindow(const window_state_t& message) {
  if (message.node.empty()) return;
  active_ = true;
  const StampedPose newest = StampedPoseOf(message.node.back());
  if (online_.empty() || newest.t > online_.back().t) {
    online_.push_back(newest);
    covariances_.push_back({newest.t, CovarianceOf(message)});
    solve_ms_ += message.solve_ms;
  }
  // What is older than the window's first node has left it.
  const Utime first = message.node.front().utime;
  while (!window_.empty() && window_.begin()->first < first) {
    if (left_.empty() || window_.begin()->second.t > left_.back().t) left_.push_back(window_.begin()->second);
    window_.erase(window_.begin());
  }
  for (const node_state_t& node : message.node) window_[node.utime] = StampedPoseOf(node);
}

void Recorder::OnMode(const tracker_mode_t& message) {
  // A restarted optimiser says the same again and again where nobody is left to answer.
  active_ = active_ || message.keyframe_seq != mode_.keyframe_seq ||
            message.keyframe_epoch != mode_.keyframe_epoch || message.mode != mode_.mode ||
            message.reason != mode_.reason;
  if (mode_changes_.empty() || message.mode != mode_.mode || message.reason != mode_.reason) {
    mode_changes_.push_back({message.utime, message.mode, message.reason});
  }
  // frame_builder counts from zero after a restart.
  if (message.keyframe_epoch != mode_.keyframe_epoch) earlier_keyframes_ += mode_.keyframe_seq + 1;
  mode_ = message;
}

Trajectory Recorder::smoothed() const {
  Trajectory all = left_;
  for (const auto& [t, pose] : window_) {
    if (all.empty() || pose.t > all.back().t) all.push_back(pose);
  }
  return all;
}

void Recorder::StartOver() {
  online_.clear();
  covariances_.clear();
  left_.clear();
  window_.clear();
}

double Recorder::progress() const {
  const auto it = statuses_.find("log_replay");
  return it == statuses_.end() ? 0 : it->second.progress;
}

bool Recorder::paused() const {
  const auto it = statuses_.find("log_replay");
  return it != statuses_.end() && it->second.state == "paused";
}

bool Recorder::Finished() const {
  const auto it = statuses_.find("frame_builder");
  return it != statuses_.end() && it->second.state == "drained" &&
         mode_.keyframe_seq >= CounterOf(it->second, "last_keyframe_seq");
}

bool Recorder::TakeActivity() {
  const bool active = active_;
  active_ = false;
  return active;
}

std::string StatusText(const Recorder& recorder) {
  std::string text = "status of the services:";
  for (const auto& [name, status] : recorder.statuses()) {
    text += "\n  " + name + ": " + status.state + ": " + status.detail;
  }
  return text;
}

std::int64_t CounterOf(const service_status_t& status, const std::string& name) {
  const auto it = std::find(status.counter_name.begin(), status.counter_name.end(), name);
  return it == status.counter_name.end() ? 0 : status.counter_value[it - status.counter_name.begin()];
}

}  // namespace evit::run
