#pragma once

#include <opencv2/core.hpp>

#include "common/geometry/camera.h"

namespace evit {

/// Takes the lens distortion out of images: in the pinhole picture epipolar lines are straight.
class Rectifier {
 public:
  /// The pinhole picture has the camera's focal lengths and shows all that it sees, but nothing more than 63
  /// degrees off the axis.
  explicit Rectifier(const Camera& camera);

  /// The camera of rectified images: no distortion, usually larger.
  const Camera& camera() const { return pinhole_; }
  /// CV_8UC1, 255 where the original image has something to say.
  const cv::Mat& valid() const { return valid_; }
  /// `image`: CV_8UC1 of the camera's size.
  cv::Mat Rectify(const cv::Mat& image) const;

 private:
  Camera pinhole_;
  cv::Mat columns_, rows_, valid_;  // where a rectified pixel lies in the original
};

}  // namespace evit
