#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/mapping/map_builder.h"
#include "tools/mapping/event_views.h"
#include "tools/mapping/frame_reader.h"

namespace evit::mapping {

/// What poses tell of.
enum class PosedFrame { kCamera, kBody, kMarker };

/// The depth camera beside the pictures; nothing without `images`.
struct DepthMaking {
  std::string images;          // as in MapMaking
  std::string camera;          // empty: that of the pictures, whose pixels it is registered to
  std::string topic;           // of a bag
  double units_per_metre = 0;  // 0: 1000, of TUM's layout 5000
};

/// What a map is made from, one of three, and how.
struct MapMaking {
  std::vector<std::string> images;  // of each camera, as formats::OpenFrames has it: need poses and cameras
  std::vector<std::string> topics;  // of each camera's bag; none: the only one of images
  DepthMaking depth;                // of the first camera's pictures
  std::string rgbd;                 // folder of RGB-D images with all they need, or one of TUM's layout
  std::string events;               // LCM log: needs poses and rig
  std::string poses, rig;
  std::vector<std::string> cameras;    // calibration of each camera
  std::optional<PosedFrame> poses_of;  // nothing: the (first) camera with images, the body with events
  SE3 T_map_world;                     // poses are in the world's frame
  std::string frames;                  // "A:B" of pictures, empty: all
  std::optional<std::pair<double, double>> seconds;  // of events, from the first pose; nothing: all
  FrameReaderOptions reader;
  EventReaderOptions event_reader;
  MapBuilderOptions build;
};

struct MadeMap {
  BuiltMap built;
  std::vector<Utime> stamps;  // of its views
};

/// Makes it, with progress bars and notes on stderr. Throws std::runtime_error naming file, what is wrong and
/// the remedy.
MadeMap MakeMap(const MapMaking& making);

}  // namespace evit::mapping
