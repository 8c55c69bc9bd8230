#pragma once

#include <string>

#include "procman/sheriff.h"
#include "tools/monitor/pipeline_watch.h"

namespace evit::monitor {

/// A pipeline on one screen of text: mode, pose, rates, latency, services.
class TopScreen : public PipelineListener {
 public:
  /// `watch` and `sheriff` must outlive this. `prefix`: of the pipeline's channels, which also names its
  /// deputy.
  TopScreen(PipelineWatch* watch, const procman::Sheriff* sheriff, std::string prefix = "");

  void OnPose(const body_pose_t& pose) override {
    pose_ = pose;
    has_pose_ = true;
  }
  void OnWindow(const window_state_t& window, double latency_ms) override;

  /// Lines that end with '\n', none longer than `columns`, at most `rows`. `color`: with ANSI colours.
  std::string Draw(int columns, int rows, bool color) const;

 private:
  std::string OthersOnBus() const;

  const PipelineWatch* watch_;
  const procman::Sheriff* sheriff_;
  std::string deputy_;  // that `evit run` with this prefix has
  bool has_pose_ = false;
  body_pose_t pose_{};
  window_state_t window_{};
  double latency_ms_ = -1;
};

}  // namespace evit::monitor
