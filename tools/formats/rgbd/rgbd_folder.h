#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/photometric/rgbd_fusion.h"

namespace evit::formats {

/// A folder of posed RGB-D images: images/NAME (colour or grey, 8 or 16 bit), depth/NAME.png (16 bit, mm, 0:
/// none), poses.txt (one row per image in the order of their names: 16 numbers, row-major 4x4, camera to map)
/// and K.txt (nine numbers, row-major 3x3, pixels). The images have no lens distortion.
class RgbdFolder {
 public:
  /// Reads all but the images. Throws std::runtime_error naming the file, what is wrong and the remedy.
  explicit RgbdFolder(const std::string& path);

  std::size_t size() const { return names_.size(); }
  /// The k-th view. Throws as the constructor does.
  RgbdView Load(std::size_t k) const;

 private:
  std::string path_;
  std::vector<std::string> names_;  // of the images, sorted
  std::vector<SE3> poses_;          // T_map_camera
  Camera camera_;                   // without size
};

}  // namespace evit::formats
