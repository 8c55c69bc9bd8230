#pragma once

#include <algorithm>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "common/config/rig_file.h"
#include "common/evaluation/trajectory.h"
#include "common/map/map_file.h"
#include "tests/helpers/painted_scene.h"

namespace evit {

/// Pictures of a painted wall: a camera of 200x150, one each 0.1 s from `begin`, of a camera that moves by
/// `width` m.
struct PaintedPictures {
  explicit PaintedPictures(int n = 16, double width = 0.35) {
    camera.width = 200, camera.height = 150;
    camera.fx = camera.fy = 150;
    camera.cx = 100, camera.cy = 75;
    for (const SE3& pose : PaintedScene::Poses(n, width)) {
      poses.push_back({begin + static_cast<Utime>(poses.size()) * 100'000, pose});
      pictures.push_back(scene.Picture(camera, pose));
    }
  }
  /// As the bytes of a PNG file.
  static std::string Png(const cv::Mat& picture) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", picture, bytes);
    return {bytes.begin(), bytes.end()};
  }
  static std::string Raw(const cv::Mat& picture) {
    return {reinterpret_cast<const char*>(picture.data), picture.total() * picture.elemSize()};
  }
  /// m, of the points of a map to the nearest edge, ascending.
  std::vector<double> Errors(const std::string& map) const {
    std::vector<double> errors;
    for (const Eigen::Vector3f& p : LoadMap(map).map.points)
      errors.push_back(scene.DistanceToEdge(p.cast<double>()));
    std::sort(errors.begin(), errors.end());
    return errors;
  }

  static constexpr Utime begin = 1'600'000'000'100'000;
  PaintedScene scene = PaintedScene::Wall();
  Camera camera;
  std::vector<cv::Mat> pictures;
  Trajectory poses;  // of the camera
};

}  // namespace evit
