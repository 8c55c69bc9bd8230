#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace evit::mapping {

/// A picture file and where it was taken from.
struct Frame {
  std::string path;
  Utime t = 0;  // its stamp, or its pose's
  SE3 T_map_camera;
};

struct FrameList {
  std::vector<Frame> frames;     // in the order of their names or stamps
  std::size_t without_pose = 0;  // left out: taken before, after or in a hole of the poses
  bool by_stamp = false;         // false: one pose for each picture, in the order of names
};

/// The pictures (PNG, JPEG, BMP, TIFF, PGM) of a folder with their poses. Stamps come from a list
/// (images.txt, rgb.txt, image_timestamps.txt or timestamps.txt beside or above the pictures: "stamp name" a
/// line, '#' comments) or from the names, where these are numbers that lie in the time of the poses (s with
/// decimals, us or ns); then poses are interpolated. Else there must be one pose for each picture, in the
/// order of names. `poses`: T_map_camera. Throws std::runtime_error naming the folder or file, what is wrong
/// and the remedy.
FrameList ListFrames(const std::string& folder, const Trajectory& poses, const std::string& poses_path);

/// A and B of "A:B", A < B. Throws std::runtime_error where that is not what the text says.
std::pair<std::size_t, std::size_t> ParseRange(const std::string& range);
/// Leaves frames A to B-1; throws where there are none.
void TakeRange(const std::string& range, FrameList* list);

}  // namespace evit::mapping
