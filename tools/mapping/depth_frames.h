#pragma once

#include <functional>
#include <string>

#include "common/evaluation/trajectory.h"
#include "common/geometry/camera.h"
#include "tools/formats/frames/frame_source.h"
#include "tools/mapping/frame_reader.h"
#include "tools/mapping/rgbd_views.h"

namespace evit::mapping {

/// A depth camera beside the one that took the pictures, or the same one.
struct DepthFrames {
  formats::FrameSource* source = nullptr;
  std::string path;
  Camera camera;
  Trajectory poses;               // T_map_depth, by the stamps of its pictures
  Utime clock_offset = 0;         // us to add to its stamps to get those of the pictures
  double units_per_metre = 1000;  // of 16-bit depth
  Utime max_apart = 25'000;       // us, between a picture and its depth
  double max_depth_m = 8;
  int threads = 2;
};

/// Depths at the edges of views that ReadEdges made: those of the depth image that is nearest in time, seen
/// from where it was taken, moved into the view. Without stamps the k-th depth image belongs to the k-th
/// picture. Views without depths are left out (`poor`). Throws std::runtime_error naming the path: another
/// clock, another size than the camera file's, fewer than three views with depths.
RgbdEdges AddDepths(ReadFrames frames, const DepthFrames& depth, const std::function<void(double)>& progress);

/// Depth of one camera as another sees it: CV_32FC1 of `to`'s size, m, 0: none; nearer things hide farther
/// ones. `to` has no distortion; `T_to_from` between the cameras.
cv::Mat MoveDepth(const cv::Mat& depth, const Camera& from, const SE3& T_to_from, const Camera& to);

}  // namespace evit::mapping
