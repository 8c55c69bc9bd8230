#pragma once

#include "tools/mapping/map_making.h"

namespace evit::mapping {

/// From pictures of one or more cameras, and of a depth camera where there is one, as MakeMap.
MadeMap MakeFromImages(const MapMaking& making);

/// From `making.rgbd`: of TUM's layout where it holds rgb.txt (or rgb/) and depth, else images/, depth/,
/// poses.txt and K.txt; as MakeMap.
MadeMap MakeFromRgbd(const MapMaking& making);

/// What was left out, to stderr.
void PrintNotes(const FrameList& list, const ReadFrames& frames);

}  // namespace evit::mapping
