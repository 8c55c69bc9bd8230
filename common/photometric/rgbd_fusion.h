#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/se3.h"
#include "common/map/photometric_map.h"

namespace evit {

/// One posed image with depth; both row-major [height][width] of the camera, which has no distortion.
struct RgbdView {
  SE3 T_map_camera;
  Camera camera;
  std::vector<float> intensity;  // 0..1
  std::vector<float> depth;      // m along the optical axis; 0: none
};

/// Puts posed RGB-D images together into a photometric map: one point for each voxel, at the mean position
/// and intensity of the pixels that fell into it. Pixels count by how finely they resolve the surface,
/// 1 / depth^2. Left out are those beside a jump of depth, where a pixel mixes two surfaces.
class RgbdFusion {
 public:
  struct Settings {
    double voxel = 0.012;    // m: smaller ones keep the views apart: four times the time, no less error
    double min_depth = 0.1;  // m
    double max_depth = 8;    // m
    double max_bend =
        0.04;  // share of the inverse depth: second difference between neighbours, beyond it: a jump
  };
  explicit RgbdFusion(const Settings& settings) : settings_(settings) {}

  /// Throws std::invalid_argument where the images are not of the camera's size.
  void Add(const RgbdView& view);

  /// Points in the order of their voxels. The same views in the same order give the same bits.
  PhotometricMap Finish() const;
  std::size_t size() const { return voxels_.size(); }

 private:
  struct Voxel {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // weighted sum
    double intensity = 0;                                // weighted sum
    double weight = 0;
  };
  Settings settings_;
  std::unordered_map<std::uint64_t, Voxel> voxels_;
};

}  // namespace evit
