#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/geometry/rig.h"
#include "common/map/map_index.h"
#include "tools/render/map_painter.h"
#include "tools/render/recorded_run.h"

namespace evit::render {

struct PaintOptions {
  cv::Size size{960, 540};
  bool dark = false;
  double turn_deg = 50;       // from where the map is seen: about the vertical
  double turn_deg_per_s = 0;  // and how it turns, in the recording's time
  std::size_t points = 1500;  // on the time surface
};

/// Draws a moment of a run: the map with the body and its path; beside it the time surface with the projected
/// map; below that the mode and how speed and uncertainty went.
class RunPainter {
 public:
  /// `run` must outlive this.
  RunPainter(const RecordedRun* run, const PointMap& map, const Rig& rig, const PaintOptions& options);

  /// The moment t (us). BGR.
  cv::Mat Paint(std::int64_t t);

 private:
  void PaintMap(std::size_t window, double turn, cv::Mat* picture);
  void PaintSurface(const window_state_t& window, cv::Mat* picture);
  void DrawSurface(const keyframe_t& keyframe, const SE3& T_map_body);
  void PaintText(const window_state_t& window, cv::Mat* picture) const;
  void PaintCurve(const std::string& name, const std::vector<double>& values, std::size_t now,
                  const cv::Rect& where, cv::Mat* picture) const;
  std::vector<Eigen::Vector3f> Visible(const SE3& T_map_camera) const;

  const RecordedRun* run_;
  MapIndex index_;
  Rig rig_;
  PaintOptions options_;
  Theme theme_;
  cv::Rect map_place_, surface_place_, curves_place_;
  MapPainter map_;
  cv::Mat surface_;                    // the last one drawn: keyframes come more seldom than windows may
  std::vector<double> speed_, sigma_;  // of each window: m/s, mm
};

}  // namespace evit::render
