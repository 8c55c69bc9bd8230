#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/mapping/depth_fusion.h"
#include "tools/mapping/frame_reader.h"

namespace evit::mapping {

struct RgbdEdges {
  ReadFrames frames;
  std::vector<KeyDepths> depths;  // of each view
};

/// Edges of the images of an RGB-D folder (images/, depth/, poses.txt, K.txt) and their depths. `begin`,
/// `end`: of the images in the order of names; stamps are their numbers in us. Throws as formats::RgbdFolder
/// does, and where fewer than three images show edges.
RgbdEdges ReadRgbd(const std::string& folder, std::size_t begin, std::size_t end,
                   const FrameReaderOptions& options, double max_depth_m,
                   const std::function<void(double)>& progress);

}  // namespace evit::mapping
