#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "common/mapping/edge_detector.h"
#include "common/mapping/posed_edges.h"
#include "tools/mapping/frame_folder.h"

namespace evit::mapping {

struct FrameReaderOptions {
  EdgeDetectorOptions edges;
  bool find_contrast = true;        // lower edges.sure_contrast where pictures show few edges with it
  std::size_t max_frames = 400;     // of more, every n-th is read: a map needs the views, not the rate
  double min_share_of_edges = 0.3;  // of the median frame's; fewer: blurred, dark or covered
  int threads = 2;
};

struct ReadFrames {
  std::vector<PosedEdges> views;
  std::vector<Utime> stamps;  // of each
  std::size_t read = 0;
  std::size_t poor = 0;  // left out: blurred, dark, covered, or nothing to see
  double contrast = 0;   // that edges were asked for; 0: none was looked for
};

/// Reads pictures, takes out the lens distortion and finds their edges. Throws std::runtime_error naming the
/// picture: not readable, of another size than the camera's. And where fewer than three show any edges.
ReadFrames ReadEdges(const FrameList& list, const Camera& camera, const FrameReaderOptions& options,
                     const std::function<void(double)>& progress);

}  // namespace evit::mapping
