#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "common/geometry/camera.h"
#include "common/localization/panorama.h"

namespace evit {

/// A keyframe's events as an upright viewer saw them, at azimuth 0 what lies ahead of R_up_camera: for each
/// direction of edges how near the next events are, made ready to be compared with the map at all yaws at
/// once.
class EventPanorama {
 public:
  /// `surface`: negated time surface (SurfaceField), of that camera. `R_up_camera`: its rotation in an
  /// upright frame, z up, of any azimuth. `directions` false: edges of the map meet events of any direction.
  EventPanorama(const cv::Mat& surface, const Camera& camera, const Eigen::Quaterniond& R_up_camera,
                bool directions = true);

  /// What an edge of the map at (stacked row, column) is worth where the viewer is turned by yaw bin
  /// 0..kColumns-1: that many numbers, zero where the edge is out of sight then. Of edges at random the mean
  /// is zero.
  const std::int16_t* Gain(int stacked_row, int column) const {
    return gain_[stacked_row].data() + (panorama::kColumns - column) % panorama::kColumns;
  }
  /// 1 where it is in sight, else 0.
  const std::int16_t* Sight(int stacked_row, int column) const {
    return sight_[stacked_row % panorama::kRows].data() + (panorama::kColumns - column) % panorama::kColumns;
  }
  /// Whether anything of that row is.
  bool InSight(int stacked_row) const { return row_in_sight_[stacked_row % panorama::kRows]; }
  /// Standard deviation of the gain of edges in sight, at random.
  double sigma() const { return sigma_; }
  /// Places of the view that hold an edge; too few say nothing.
  int occupied() const { return occupied_; }

 private:
  // Rows backwards and twice, so that a column's yaws are neighbours.
  using Row = std::array<std::int16_t, std::size_t{2} * panorama::kColumns>;
  std::vector<Row> gain_, sight_;
  std::array<bool, panorama::kRows> row_in_sight_{};
  double sigma_ = 1;
  int occupied_ = 0;
};

}  // namespace evit
